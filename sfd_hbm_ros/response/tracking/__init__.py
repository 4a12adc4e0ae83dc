"""The operating point of a machine, followed with its history."""
