"""Measurements of speed, accuracy and endurance, run by hand."""
