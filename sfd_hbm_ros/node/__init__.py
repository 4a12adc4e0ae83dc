"""The nodes of the ROS graph; the only room that imports rclpy."""

import os

# To be set before numpy is imported. The matrices are small: more threads only take processor
# time from one another, and from the other nodes of the machine.
for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
