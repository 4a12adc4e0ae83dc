"""Squeeze film damper rotors predicted live by harmonic balance, for ROS 2."""
