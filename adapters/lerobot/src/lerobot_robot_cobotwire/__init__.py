"""The arms of cobotwire as a robot and a teleoperator of LeRobot, both of the type ``cobotwire``.

LeRobot imports this package because of its name, and finds each class by the class of its
configuration.
"""

from lerobot_robot_cobotwire.robot import CobotwireRobot as CobotwireRobot
from lerobot_robot_cobotwire.robot import CobotwireRobotConfig as CobotwireRobotConfig
from lerobot_robot_cobotwire.teleoperator import CobotwireTeleoperator as CobotwireTeleoperator
from lerobot_robot_cobotwire.teleoperator import (
    CobotwireTeleoperatorConfig as CobotwireTeleoperatorConfig,
)
