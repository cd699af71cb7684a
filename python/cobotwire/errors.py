"""Everything that can go wrong, sorted by whose fault it is.

One root, seven branches, each also the built-in exception that a caller would expect. The
attributes are data; the text is made from them here and nowhere else.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


class CobotwireError(Exception):
    """The root of every error that cobotwire raises on purpose.

    It can be pickled, so that it comes whole out of another process.
    """

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self.args), self.__dict__


def _again(kind: type[CobotwireError], args: tuple[Any, ...]) -> CobotwireError:
    """An error with its text; the attributes are set by whoever unpickles it."""
    error = kind.__new__(kind)
    # Not the branch's own, which takes the data that the text was made of.
    Exception.__init__(error, *args)
    return error


class UsageError(CobotwireError, ValueError):
    """The caller's fault, found before a byte was sent.

    Attributes:
        argument: where in the call, for example ``angles[2]``.
        value: what was given.
        allowed: what would have been right.
    """

    def __init__(self, argument: str, value: Any, allowed: str) -> None:
        self.argument = argument
        self.value = value
        self.allowed = allowed
        super().__init__(f"{argument} is {_short(value)}; allowed: {allowed}")


class ProtocolError(CobotwireError):
    """The peer's fault: bytes that the protocol does not allow.

    Attributes:
        reason: a word for programs, one of the noise reasons or ``bad-value``, ``trailing``,
            ``bad-text``.
        offset: where in ``data`` it went wrong, in bytes.
        data: the bytes in question.
    """

    def __init__(self, reason: str, offset: int, data: bytes, detail: str) -> None:
        self.reason = reason
        self.offset = offset
        self.data = data
        super().__init__(f"{detail} (at byte {offset} of {data.hex(' ').upper() or 'nothing'})")


class LinkError(CobotwireError, OSError):
    """The link's fault: the port could not be opened, or it went away.

    Attributes:
        url: the port or URL in question.
        detail: what went wrong with it.
        written: how many bytes of a write that failed had been taken all the same.
    """

    def __init__(self, url: str, detail: str, written: int = 0) -> None:
        self.url = url
        self.detail = detail
        self.written = written
        super().__init__(f"{url}: {detail}")


class ReplyTimeout(CobotwireError, TimeoutError):
    """Silence: the deadline passed without the answer, or the acknowledgement that was waited for.

    Attributes:
        command: the name of the command that was asked.
        waited: seconds from the request to giving up.
        heard: what came meanwhile instead, one line each.
        tries: how often it was asked; 0 if it could not be sent without risk of a wrong answer.
        asked: the call with its arguments, for example ``get_encoder(joint=1)``.
    """

    def __init__(
        self,
        command: str,
        waited: float,
        heard: tuple[str, ...],
        tries: int = 1,
        asked: str = "",
    ) -> None:
        self.command = command
        self.waited = waited
        self.heard = heard
        self.tries = tries
        self.asked = asked or command
        meanwhile = "; ".join(heard) if heard else "nothing"
        super().__init__(
            f"no answer to {self.asked} within {waited:.3f} s, {_often(tries)}; heard: {meanwhile}"
        )


class MotionTimeout(CobotwireError, TimeoutError):
    """The arm has not come to its target in time, or stands still short of it.

    It is not told to stop: call ``stop()`` where it should.

    Attributes:
        target: where it should go.
        waited: seconds from the start of waiting to giving up.
        standing: whether it stood still at the end; False where that is not known.
    """

    def __init__(self, target: tuple[float, ...], waited: float, standing: bool) -> None:
        self.target = target
        self.waited = waited
        self.standing = standing
        how = "stands still short of" if standing else "has not reached"
        super().__init__(f"the arm {how} {list(target)} after {waited:.1f} s")


def _often(tries: int) -> str:
    return {0: "not asked", 1: "asked once", 2: "asked twice"}.get(tries, f"asked {tries} times")


class CaptureError(CobotwireError, ValueError):
    """A file's fault: a recording that is none, is damaged, or cannot be written on.

    Attributes:
        name: the file.
        offset: where in it, in bytes; the beginning of the block in question.
    """

    def __init__(self, name: str, offset: int, detail: str) -> None:
        self.name = name
        self.offset = offset
        super().__init__(f"{name}: {detail} (at byte {offset})")


class ScenarioError(CobotwireError, ValueError):
    """A scenario file's fault: it cannot be used.

    Attributes:
        problems: all that is wrong, in the order of the file, each as ``file:line:column: what``.
    """

    def __init__(self, problems: Sequence[str]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(self.problems))


def _short(value: Any, limit: int = 80) -> str:
    text = repr(value)
    return text if len(text) <= limit else text[: limit - 3] + "..."
