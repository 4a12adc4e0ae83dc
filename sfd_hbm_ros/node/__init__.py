"""The nodes of the ROS graph; the only room that imports rclpy."""
