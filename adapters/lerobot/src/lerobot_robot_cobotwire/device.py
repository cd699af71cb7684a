"""What the robot and the teleoperator share: an arm that is opened, read and closed."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from cobotwire import UsageError, editions
from cobotwire.protocol.addresses import devices_of
from lerobot_robot_cobotwire.features import Positions
from lerobot_robot_cobotwire.interface import DeviceAlreadyConnectedError, DeviceNotConnectedError


@dataclass(kw_only=True)
class ArmConfig:
    """The arm and its port. LeRobot prints the comments as help."""

    # The protocol of the arm, such as mycobot280; `cobotwire identify PORT` finds it out.
    edition: str
    # A serial port, or a URL such as socket://127.0.0.1:9000.
    port: str
    # Bits a second; by default that of the edition.
    baudrate: int | None = None
    # The device, such as LEFT, of an arm that has several.
    address: str | None = None
    # Whether the arm has a gripper: gripper.pos, 0 (closed) to 100 (open).
    gripper: bool = False


class ArmDevice:
    """An arm that needs no calibration, since it keeps its zero positions itself.

    Methods may raise DeviceNotConnectedError, LinkError if the port is gone, and ReplyTimeout.
    """

    name: str
    # Arguments of the client.
    options: dict[str, Any]
    cameras: Mapping[str, Any] = MappingProxyType({})

    def __init__(self, config: ArmConfig) -> None:
        """Find the edition and what it reports; nothing is opened.

        Raises:
            UsageError: there is no such edition, or its arm has several devices and none is named.
        """
        self._arm: Any = None
        self._config, self.edition = config, editions.load(config.edition)
        self.table = self.edition.TABLE
        devices = [device.name for device in devices_of(self.table)]
        if len(devices) > 1 and config.address is None:
            raise UsageError("address", None, ", ".join(devices))
        self.positions = Positions(self.table, config.gripper)

    @property
    def action_features(self) -> dict[str, Any]:
        """The type of each position."""
        return dict.fromkeys(self.positions.names, float)

    @property
    def is_connected(self) -> bool:
        """Whether the port is open."""
        return self._arm is not None

    @property
    def is_calibrated(self) -> bool:
        """True: there is nothing to calibrate."""
        return True

    def calibrate(self) -> None:
        """Do nothing."""

    def configure(self) -> None:
        """Prepare the arm."""

    def connect(self, calibrate: bool = True) -> None:
        """Open cameras and port, and prepare the arm.

        Raises:
            ArmNotReady: a robot has no power, is paused, or reports an error.
        """
        if self._arm is not None:
            raise DeviceAlreadyConnectedError(f"{self.name} is connected already")
        port, speed, address = self._config.port, self._config.baudrate, self._config.address
        with ExitStack() as opened:
            # Cameras close last, after stop was sent to the arm.
            for camera in self.cameras.values():
                opened.enter_context(camera)
            client = self.edition.CLIENT(port, speed, address=address, **self.options)
            self._arm = opened.enter_context(client)
            opened.callback(setattr, self, "_arm", None)
            self.configure()
            self._opened = opened.pop_all()

    def disconnect(self) -> None:
        """Close everything; a robot is stopped first if ``on_error`` is stop."""
        _ = self.arm
        # LeRobot calls this in `finally`.
        error = sys.exception()
        self._opened.__exit__(type(error) if error else None, error, None)

    @property
    def arm(self) -> Any:
        """The client of the edition."""
        if self._arm is None:
            raise DeviceNotConnectedError(f"{self.name} is not connected: call connect() first")
        return self._arm
