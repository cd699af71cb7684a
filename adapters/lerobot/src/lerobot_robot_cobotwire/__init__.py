"""The arms of cobotwire as a robot and a teleoperator of LeRobot.

LeRobot imports this package because of its name, and finds the classes by those of their
configurations. Both are registered as ``cobotwire``.
"""

from lerobot_robot_cobotwire.robot import CobotwireRobot, CobotwireRobotConfig
from lerobot_robot_cobotwire.teleoperator import CobotwireTeleoperator, CobotwireTeleoperatorConfig

__all__ = [
    "CobotwireRobot",
    "CobotwireRobotConfig",
    "CobotwireTeleoperator",
    "CobotwireTeleoperatorConfig",
]
