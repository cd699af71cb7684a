"""The robot: an arm with motors, which follows the targets of a policy or a teleoperator."""

from __future__ import annotations

import logging
from dataclasses import dataclass, field
from typing import Any

from cobotwire import DeadMan, Limits, UsageError
from cobotwire.client.opening import check_seconds
from cobotwire.inspect.readiness import check_ready
from cobotwire.protocol.limits import AXES
from lerobot_robot_cobotwire.device import ArmConfig, ArmDevice
from lerobot_robot_cobotwire.features import GRIPPER, Targets, find
from lerobot_robot_cobotwire.interface import (
    CameraConfig,
    Robot,
    RobotConfig,
    make_cameras_from_configs,
)


@RobotConfig.register_subclass("cobotwire")
@dataclass(kw_only=True)
class CobotwireRobotConfig(ArmConfig, RobotConfig):
    """An arm with motors, and its limits."""

    # The speed at which the arm follows targets, in percent; it is also the highest speed allowed.
    max_speed: int = 50
    # The lowest and the highest angle of each joint in degrees; by default those of the edition.
    joint_limits: list[tuple[float, float] | None] | None = None
    # Where the end of the arm may be sent: ranges for x, y and z in millimetres; default: anywhere.
    workspace: list[tuple[float, float] | None] | None = None
    # Seconds without an action after which the arm is stopped.
    silence: float = 1.0
    # stop: stop the arm when it is disconnected; leave: let it end its motion.
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
        self.config = config
        check_seconds("silence", config.silence)
        limits = Limits(config.joint_limits, speed=config.max_speed, workspace=config.workspace)
        self.options = {"limits": limits, "on_error": config.on_error}
        self._targets = Targets(self.table, self.positions.joints, config.gripper, limits)
        self.cameras = make_cameras_from_configs(config.cameras)

    @property
    def observation_features(self) -> dict[str, Any]:
        """The type of each position that the arm reports, and the shape of each picture."""
        pictures = {n: (c.height, c.width, 3) for n, c in self.config.cameras.items()}
        return dict.fromkeys(self.positions.names, float) | pictures

    @property
    def action_features(self) -> dict[str, Any]:
        """The type of each target."""
        return dict.fromkeys(self._targets.limits, float)

    def configure(self) -> None:
        """Let new targets replace the present one, where the edition has a mode for that."""
        check_ready(self.arm, "send_action", self.config.port)
        if command := find(self.table, "choose targets"):
            getattr(self.arm, command.name)(1)  # in mode 0, targets are queued
        self._sent, self._is_inside = self.positions.read(self.arm), True

    def connect(self, calibrate: bool = True) -> None:
        """Connect, and start the dead-man switch, which stops the arm if no action comes."""
        self._acted = False
        super().connect(calibrate)
        self._opened.push(self._stop)
        self._dead_man = self._opened.enter_context(DeadMan(self.arm, self.config.silence))

    def _stop(self, kind: object, error: BaseException | None, traceback: object) -> None:
        """Stop the arm if no error is known; after an error, the client stops it.

        A program of LeRobot may handle Ctrl-C before it disconnects the arm, so an end without an
        error can be an interruption, too.
        """
        if error is None and self._acted and self.config.on_error == "stop":
            self.arm._stop_all()

    def get_observation(self) -> dict[str, Any]:
        """Return where the arm is, and what the cameras see."""
        pictures = {name: camera.read_latest() for name, camera in self.cameras.items()}
        return self.positions.read(self.arm) | pictures

    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        """Send targets without waiting, clipped to the limits; return what was sent.

        If the end of the arm would leave the workspace, the joints keep their last targets.

        Raises:
            UsageError: a target is missing, has an unknown name, or is not a finite number.
        """
        sent, speed = self._targets.clip(action), self.config.max_speed
        joints, gripper = self.positions.joints, self._targets.gripper
        self._dead_man.alive()
        self._acted = True
        try:
            self.arm.move_angles([sent[name] for name in joints], speed, wait=False)
            self._is_inside = True
        except UsageError as error:
            if error.argument not in AXES:
                raise
            if self._is_inside:
                logging.warning("%s; the joints keep their last targets", error)
            self._is_inside = False
            sent |= {name: self._sent[name] for name in joints}
        if gripper is not None and round(sent[GRIPPER]) != round(self._sent.get(GRIPPER, -1)):
            getattr(self.arm, gripper.name)(round(sent[GRIPPER]), speed)
        self._sent = sent
        return {**sent}
