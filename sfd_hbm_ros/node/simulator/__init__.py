"""A machine that is not there: its speed and its measured orbits."""
