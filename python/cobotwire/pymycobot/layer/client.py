"""Calls our client as the maker's library is called."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeVar

from cobotwire.client import Client
from cobotwire.protocol.errors import ProtocolError, ReplyTimeout, UsageError
from cobotwire.pymycobot.layer.absent import why_absent
from cobotwire.pymycobot.layer.policy import policy
from cobotwire.pymycobot.layer.results import plain

OnFailure = Literal["raise", "return"]
Value = TypeVar("Value")
# The library waits three times half a second for an acknowledgement.
ACK_SECONDS = 1.5
# What the library returns for a request that was acknowledged, and for a call that failed.
DONE, FAILED = 1, -1


class CompatibleClient:
    """Our client of a robot, with the constructor and the methods of the maker's class.

    ``arm`` is our client; its methods may be called too.

    The parameters of the constructor are the maker's. ``timeout`` and ``thread_lock`` have no
    effect: our client waits for a reply as long as the edition says, and many threads may always
    share an arm. ``debug`` logs all frames; ``save_serial_log`` has no effect, since our clients
    record traffic themselves (``record``).

    With ``errors="raise"``, the default, a call that fails raises our error. With
    ``errors="return"`` it returns -1, as the library does. An argument that is not allowed raises
    UsageError in both cases.
    """

    NATIVE: ClassVar[type[Client]]
    # How long a call waits for an acknowledgement, and what a call that does not wait returns.
    ACK_SECONDS: ClassVar[float] = ACK_SECONDS
    QUIET: ClassVar[int | None] = None
    # What a one-way request returns, and when. Older classes serve firmware of any age, and old
    # firmware acknowledges nothing: then the request returns 1, or a list with 1, once it is sent.
    ONE_WAY: ClassVar[str] = "acknowledged"

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Say why a name of the maker's class has no counterpart."""
            message = f"{type(self).__name__!r} object has no attribute {name!r}"
            why = why_absent(type(self), name)
            raise AttributeError(f"{message}: {why}" if why else message, name=name, obj=self)

    def _open_serial(
        self, port: str, baudrate: str | int, debug: bool, errors: OnFailure | None
    ) -> None:
        self._open(partial(self.NATIVE, port, baudrate=int(baudrate)), debug, errors)

    def _open_socket(self, host: str, port: int, debug: bool, errors: OnFailure | None) -> None:
        self._open(partial(self.NATIVE, f"socket://{host}:{port}"), debug, errors)

    def _open(self, open_arm: partial[Client], debug: bool, errors: OnFailure | None) -> None:
        if errors not in (None, "raise", "return"):
            raise UsageError("errors", errors, "'raise' or 'return'")
        if debug:
            import logging

            logging.basicConfig()
            logging.getLogger("cobotwire.traffic").setLevel(logging.DEBUG)
        self._raises = (errors or policy.errors) == "raise"
        self._open_arm = open_arm
        self.open()

    def open(self) -> None:
        """Open the port again after ``close``; the constructor has opened it."""
        port = self._open_arm.args[0]
        policy.free(port)
        self.arm: Any = self._open_arm()
        self._is_open = True
        policy.opened(self.arm, self, port)

    def close(self) -> None:
        """Close the port. Nothing is sent to the arm."""
        self._is_open = False
        policy.closed(self.arm)
        self.arm.close()

    def _send_acked(
        self,
        call: Callable[..., None],
        *arguments: Any,
        quiet: bool = False,
        gives: Callable[[Any], Any] = plain,
    ) -> Any:
        """Send a request once; unless ``quiet``, wait for its acknowledgement, and return 1.

        ``gives`` converts the 1 to the result of the library's method.
        """
        if self.ONE_WAY != "acknowledged":
            call(*arguments)
            return [DONE] if self.ONE_WAY == "listed" else DONE
        if quiet:
            call(*arguments)
            return self.QUIET
        try:
            call(*arguments, ack_within=self.ACK_SECONDS)
        except (ProtocolError, ReplyTimeout):
            return self._failed()
        return gives(DONE)

    def _send(self, call: Callable[..., None], *arguments: Any) -> None:
        """Send a request that the robot does not acknowledge."""
        call(*arguments)

    def _finish(self, call: Callable[..., None], *arguments: Any) -> int:
        """Send a request that the robot does not acknowledge; return 1, as the library does."""
        call(*arguments)
        return DONE

    def _query(
        self, convert: Callable[[Any], Value], call: Callable[..., Any], *arguments: Any
    ) -> Value | int:
        """Return the result of a query as the library gives it."""
        try:
            return convert(call(*arguments))
        except (ProtocolError, ReplyTimeout):
            return self._failed()

    def _lacks(self, **given: object) -> None:
        """Reject arguments that the edition cannot send."""
        for name, value in given.items():
            if value is not None:
                edition = self.arm.table.edition
                raise UsageError(
                    name, value, f"None, as the edition {edition} has no such argument"
                )

    def _failed(self) -> int:
        """Raise the error that is being handled, or return what the library returns."""
        if self._raises:
            raise
        return FAILED
