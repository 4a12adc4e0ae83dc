"""Squeeze film damper rotors predicted live by harmonic balance, for ROS 2."""

__version__ = "0.1.0"
