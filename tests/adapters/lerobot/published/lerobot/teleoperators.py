"""A stand-in for LeRobot's teleoperators."""

from lerobot.robots import SHARED, Robot, RobotConfig


class TeleoperatorConfig(RobotConfig):
    pass


class Teleoperator(Robot):
    required = f"{SHARED} feedback_features get_action send_feedback"
