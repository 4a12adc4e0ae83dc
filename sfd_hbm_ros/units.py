"""The unit of speed that people use; inside, speeds are in rad/s."""

import math

RPM = math.pi / 30.0
"""One revolution a minute [rad/s]."""
