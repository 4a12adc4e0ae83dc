"""Pictures and tables of what the solver finds."""
