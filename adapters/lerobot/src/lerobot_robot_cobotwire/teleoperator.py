"""The teleoperator: an arm that a person moves by hand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cobotwire import UsageError
from lerobot_robot_cobotwire.device import ArmConfig, ArmDevice
from lerobot_robot_cobotwire.features import find
from lerobot_robot_cobotwire.interface import Teleoperator, TeleoperatorConfig


@TeleoperatorConfig.register_subclass("cobotwire")
@dataclass(kw_only=True)
class CobotwireTeleoperatorConfig(ArmConfig, TeleoperatorConfig):
    """An arm that a person moves."""

    # Whether to release the motors when the port is opened. The arm sinks: hold it.
    released: bool = False


class CobotwireTeleoperator(ArmDevice, Teleoperator):
    """An arm that a person moves by hand; it is only read."""

    config_class = CobotwireTeleoperatorConfig
    name = "cobotwire"

    def __init__(self, config: CobotwireTeleoperatorConfig) -> None:
        ArmDevice.__init__(self, config)
        Teleoperator.__init__(self, config)
        self.config, self.options = config, {"on_error": "leave"}
        self._release = find(self.table, "release all motors") if config.released else None
        if config.released and self._release is None:
            message = f"edition {config.edition} has no command that releases all motors"
            raise UsageError("released", True, message=message)

    @property
    def feedback_features(self) -> dict[str, Any]:
        """Empty: the arm takes no feedback."""
        return {}

    def configure(self) -> None:
        """Check that the arm replies, and release its motors if the configuration says so."""
        self.get_action()
        if self._release is not None:
            getattr(self.arm, self._release.name)()

    def get_action(self) -> dict[str, Any]:
        """Return where the arm is."""
        return {**self.positions.read(self.arm)}

    def send_feedback(self, feedback: dict[str, Any]) -> None:
        """Do nothing: the arm takes no feedback."""
