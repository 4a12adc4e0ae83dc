"""What lies ahead of the operating point, and the alarm of it."""
