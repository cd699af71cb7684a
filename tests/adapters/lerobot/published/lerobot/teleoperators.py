"""A stand-in for LeRobot's teleoperators: what a plugin must have."""

from lerobot.robots import REQUIRED, Robot, RobotConfig


class TeleoperatorConfig(RobotConfig):
    pass


class Teleoperator(Robot):
    required = frozenset((*REQUIRED, "feedback_features", "get_action", "send_feedback"))
