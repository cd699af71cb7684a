"""Take part in ROS 2 without ROS: its topics and messages on DDS. See ``docs/ros2.md``."""
