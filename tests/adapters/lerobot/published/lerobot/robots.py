"""A stand-in for LeRobot's robots: what a plugin must have."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

Config = TypeVar("Config", bound=type)
REQUIRED = (
    *("action_features", "calibrate", "configure", "connect", "disconnect"),
    *("is_calibrated", "is_connected"),
)


@dataclass(kw_only=True)
class RobotConfig:
    id: str | None = None

    @classmethod
    def register_subclass(cls, name: str) -> Callable[[Config], Config]:
        return lambda config: config


class Robot:
    required = frozenset((*REQUIRED, "observation_features", "get_observation", "send_action"))

    def __init__(self, config: Any) -> None:
        self.id = config.id
