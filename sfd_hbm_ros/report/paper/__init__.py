"""The reference paper: its figures computed again, and its claims judged one by one."""
