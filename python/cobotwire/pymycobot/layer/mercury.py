"""Methods of the Mercury classes that classes of other robots lack."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any, ClassVar

from cobotwire.client import Client
from cobotwire.protocol.errors import ProtocolError, ReplyTimeout, UsageError
from cobotwire.pymycobot.layer.client import OnFailure
from cobotwire.pymycobot.layer.closed_loop import Reporting
from cobotwire.pymycobot.layer.naming import naming
from cobotwire.pymycobot.layer.results import plain

BASE_COORDS = 2


class ByPort(Reporting):
    """An arm of a two-armed robot if its port is one of ``PORTS``; otherwise a single arm.

    Only an arm that is mounted on a body has coordinates from the waist, and the joints 11 to 13.
    """

    ELSEWHERE: ClassVar[type[Client]]
    PORTS: ClassVar[tuple[str, ...]]

    def _open_serial(
        self, port: str, baudrate: str | int, debug: bool, errors: OnFailure | None
    ) -> None:
        native = self.NATIVE if port in self.PORTS else self.ELSEWHERE
        self._open(partial(native, port, baudrate=int(baudrate)), debug, errors)

    def open(self) -> None:
        """Open the port again after ``close``; query whether the arm reports ends of motions."""
        super().open()
        try:
            self._waits = bool(self.arm.get_limit_switch().motion_ends)
        except (ProtocolError, ReplyTimeout):
            # An arm that is not switched on may be opened.
            self._waits = True

    def _only_here(self, name: str) -> Any:
        """Return a method that only the client of an arm on a robot's body has.

        Raises:
            UsageError: the robot has only one arm.
        """
        if isinstance(self.arm, self.NATIVE):
            return getattr(self.arm, name)
        ports = " or ".join(self.PORTS)
        message = f"{name}() needs an arm that is mounted on a body: its port is {ports}"
        raise UsageError("port", message=message)

    @naming(target="data")
    def is_in_position(self, data: Sequence[float], mode: int = 0) -> Any:
        """Check whether angles (0), coordinates (1) or those from the waist (2) are reached."""
        if mode == BASE_COORDS:
            return self._query(plain, self._only_here("is_in_position_base_coords"), data)
        return super().is_in_position(data, mode)
