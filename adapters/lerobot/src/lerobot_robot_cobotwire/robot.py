"""The robot: an arm with motors, which follows the targets of a policy or a teleoperator."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, field
from typing import Any

from cobotwire import Limits, UsageError
from cobotwire.inspect.readiness import check_ready
from lerobot_robot_cobotwire.device import ArmConfig, ArmDevice
from lerobot_robot_cobotwire.features import GRIPPER, Targets, newest_target_mode
from lerobot_robot_cobotwire.interface import (
    CameraConfig,
    Robot,
    RobotConfig,
    make_cameras_from_configs,
)


@RobotConfig.register_subclass("cobotwire")
@dataclass(kw_only=True)
class CobotwireRobotConfig(ArmConfig, RobotConfig):
    """Which arm with motors there is, and what it may do."""

    # The speed at which the arm follows targets, and the highest it may have, in percent.
    max_speed: int = 50
    # The lowest and the highest angle of each joint in degrees; by default those of the edition.
    joint_limits: list[tuple[float, float] | None] | None = None
    # stop: stop the arm if an error or Ctrl-C disconnects it; leave: let it end its motion.
    on_error: str = "stop"
    # Cameras by name, as in LeRobot's own robots.
    cameras: dict[str, CameraConfig] = field(default_factory=dict)


class CobotwireRobot(ArmDevice, Robot):
    """An arm with motors."""

    config_class = CobotwireRobotConfig
    name = "cobotwire"

    def __init__(self, config: CobotwireRobotConfig) -> None:
        """Check the configuration; nothing is opened.

        Raises:
            UsageError: there is no such edition, its arm has no motors, or an option is wrong.
        """
        ArmDevice.__init__(self, config)
        if self.table.find_role("joint targets") is None:
            message = f"the arm of edition {config.edition} has no motors: use it as a teleoperator"
            raise UsageError("edition", config.edition, message=message)
        # A dataset names the edition as its type of robot.
        self.name = f"{type(self).name}_{config.edition}"
        Robot.__init__(self, config)
        self.config, self._opening = config, -1
        self._limits = Limits(joints=config.joint_limits)
        self._targets = Targets(self.table, self.positions.joints, config.gripper, self._limits)
        self.cameras = make_cameras_from_configs(config.cameras)

    @property
    def observation_features(self) -> dict[str, Any]:
        """The type of each position that the arm reports, and the shape of each picture."""
        cameras = self.config.cameras.items()
        pictures = {name: (each.height, each.width, 3) for name, each in cameras}
        return dict.fromkeys(self.positions.names, float) | pictures

    @property
    def action_features(self) -> dict[str, Any]:
        """The type of each target."""
        return dict.fromkeys(self._targets.limits, float)

    def connect(self, calibrate: bool = True) -> None:
        """Open the cameras and the port. The arm does not move.

        Raises:
            ArmNotReady: it has no power, is paused, or reports an error.
        """
        with ExitStack() as opened:
            for camera in self.cameras.values():
                camera.connect()
                opened.callback(camera.disconnect)
            self.open(opened, limits=self._limits, on_error=self.config.on_error)

    def configure(self) -> None:
        """Let new targets replace the present one, where the edition has a mode for that."""
        check_ready(self.arm, "send_action", self.config.port)
        if found := newest_target_mode(self.table):
            command, mode = found
            getattr(self.arm, command.name)(mode)

    def get_observation(self) -> dict[str, Any]:
        """Return where the arm is, and what the cameras see."""
        pictures = {name: camera.read_latest() for name, camera in self.cameras.items()}
        return self.positions.read(self.arm) | pictures

    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        """Send targets without waiting, clipped to the limits; return what was sent.

        Raises:
            UsageError: a target is missing, is not a finite number, or is for no joint.
        """
        sent, speed = self._targets.clip(action), self.config.max_speed
        self.arm.move_angles([sent[name] for name in self.positions.joints], speed, wait=False)
        gripper = self._targets.gripper
        if gripper is not None and self._opening != (opening := round(sent[GRIPPER])):
            getattr(self.arm, gripper.name)(opening, speed)
            self._opening = opening
        return {**sent}
