"""What the nodes say and hear: the only place that builds and reads ROS messages."""
