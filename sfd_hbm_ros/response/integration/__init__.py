"""Time integration of a machine: run-ups and coast-downs."""
