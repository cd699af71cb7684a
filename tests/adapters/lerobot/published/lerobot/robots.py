"""A stand-in for LeRobot's robots; ``required`` is what a plugin must have."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

SHARED = "action_features calibrate configure connect disconnect is_calibrated is_connected"


@dataclass(kw_only=True)
class RobotConfig:
    id: str | None = None

    @classmethod
    def register_subclass(cls, name: str) -> Callable[[type], type]:
        return lambda config: config


class Robot:
    required = f"{SHARED} get_observation observation_features send_action"

    def __init__(self, config: Any) -> None:
        self.id = config.id
