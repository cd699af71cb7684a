"""Every error that cobotwire raises, sorted by whose fault it is.

One root has seven branches; each is also the built-in exception that a caller would expect. The
attributes are data, and the text is made from them here and nowhere else.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


class CobotwireError(Exception):
    """The root of every error that cobotwire raises on purpose.

    It can be pickled, so it keeps its attributes when it leaves another process.
    """

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self.args), self.__dict__


def _again(kind: type[CobotwireError], args: tuple[Any, ...]) -> CobotwireError:
    """Return an unpickled error with its text; pickle restores the attributes afterwards."""
    error = kind.__new__(kind)
    # Not the subclass's constructor: that takes the data that the text was made from.
    Exception.__init__(error, *args)
    return error


class UsageError(CobotwireError, ValueError):
    """The caller's fault, found before a byte was sent.

    The text is ``ARGUMENT is VALUE; allowed: ALLOWED`` for a bad value. For everything else (a file
    that does not exist, a missing argument or package) ``message`` is the whole text.

    Attributes:
        argument: where in the call, for example ``angles[2]``.
        value: what was given; None if the error is not about a value.
        allowed: which values are allowed; empty if the error is not about a value.
    """

    def __init__(
        self, argument: str, value: Any = None, allowed: str = "", *, message: str = ""
    ) -> None:
        self.argument = argument
        self.value = value
        self.allowed = allowed
        super().__init__(message or f"{argument} is {_short(value)}; allowed: {allowed}")


class ProtocolError(CobotwireError):
    """The peer's fault: bytes that the protocol does not allow.

    Attributes:
        reason: a word for programs: a noise reason, ``bad-value``, ``trailing`` or ``bad-text``.
        offset: which byte of ``data`` is wrong.
        data: the bytes in question.
    """

    def __init__(self, reason: str, offset: int, data: bytes, detail: str) -> None:
        self.reason = reason
        self.offset = offset
        self.data = data
        super().__init__(f"{detail} (at byte {offset} of {data.hex(' ').upper() or 'nothing'})")


class LinkError(CobotwireError, OSError):
    """The transport's fault: the port could not be opened, or it went away.

    Attributes:
        url: the port or URL in question.
        detail: what went wrong with it.
        written: how many bytes were written before the write failed.
    """

    def __init__(self, url: str, detail: str, written: int = 0) -> None:
        self.url = url
        self.detail = detail
        self.written = written
        super().__init__(f"{url}: {detail}")


class ReplyTimeout(CobotwireError, TimeoutError):
    """The deadline passed without the reply, or without the acknowledgement that was waited for.

    Attributes:
        command: the name of the command.
        waited: seconds from the request to giving up.
        received: what came meanwhile instead, one line each.
        attempts: how often the request was sent; 0 if a late reply could be mistaken for its own.
        request: the call with its arguments, for example ``get_encoder(joint=1)``.
    """

    def __init__(
        self,
        command: str,
        waited: float,
        received: tuple[str, ...],
        attempts: int = 1,
        request: str = "",
    ) -> None:
        self.command = command
        self.waited = waited
        self.received = received
        self.attempts = attempts
        self.request = request or command
        meanwhile = "; ".join(received) if received else "nothing"
        if attempts:
            times = "1 attempt" if attempts == 1 else f"{attempts} attempts"
            what = f"no reply to {self.request} within {waited:.3f} s after {times}"
        else:
            what = f"{self.request} was not sent within {waited:.3f} s"
        super().__init__(f"{what}; received meanwhile: {meanwhile}")


class MotionTimeout(CobotwireError, TimeoutError):
    """The arm did not reach its target in time, or stopped before it.

    The arm is not stopped: call ``stop()`` if it should be.

    Attributes:
        target: where the arm was sent.
        waited: seconds from the start of waiting to giving up.
        standing: whether the arm stood still at the end; False if that is not known.
    """

    def __init__(self, target: tuple[float, ...], waited: float, standing: bool) -> None:
        self.target = target
        self.waited = waited
        self.standing = standing
        how = "stands still short of" if standing else "has not reached"
        super().__init__(f"the arm {how} {list(target)} after {waited:.1f} s")


class CaptureError(CobotwireError, ValueError):
    """A file's fault: it is not a recording, is damaged, or cannot be continued.

    Attributes:
        name: the file.
        offset: where the faulty block starts in the file, in bytes.
    """

    def __init__(self, name: str, offset: int, detail: str) -> None:
        self.name = name
        self.offset = offset
        super().__init__(f"{name}: {detail} (at byte {offset})")


class ScenarioError(CobotwireError, ValueError):
    """A scenario file's fault: it cannot be used.

    Attributes:
        problems: every problem in the order of the file, each as ``file:line:column: what``.
    """

    def __init__(self, problems: Sequence[str]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(self.problems))


def _short(value: Any, limit: int = 80) -> str:
    text = repr(value)
    return text if len(text) <= limit else text[: limit - 3] + "..."
