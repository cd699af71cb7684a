"""Define every error that cobotwire raises: one class for each party that can be at fault.

Most classes also derive from the built-in exception that a caller would expect. The attributes are
data, and this module alone makes the text from them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import Any, Literal, NamedTuple

from cobotwire.protocol.error_texts import error_text
from cobotwire.protocol.printable import printable

# The name of an argument in ``angles[2]``, ``coords.x``, ``len(data)`` and ``account, password``.
_FIRST_NAME = re.compile(r"(?<![\w.\[])(?!len\()[A-Za-z_]\w*")


def did_you_mean(given: object, known: Iterable[str]) -> str:
    """Return a hint for a misspelt word, such as ``; did you mean late?``, or an empty text."""
    near = get_close_matches(given, list(known), n=1) if isinstance(given, str) else []
    return f"; did you mean {near[0]}?" if near else ""


class CobotwireError(Exception):
    """The base class of every error that cobotwire raises.

    Errors keep their attributes when they are pickled, for example between processes. The text of
    an error is printable, whatever it quotes; the attributes are as they were given.
    """

    def __init__(self, *lines: str) -> None:
        super().__init__("\n".join(map(printable, lines)))

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self.args), self.__dict__


def _again(kind: type[CobotwireError], args: tuple[Any, ...]) -> CobotwireError:
    """Return an unpickled error with its text; pickle restores the attributes afterwards."""
    error = kind.__new__(kind)
    # The subclass's constructor takes the data from which it makes the text, not the text.
    Exception.__init__(error, *args)
    return error


class UsageError(CobotwireError, ValueError):
    """An error of the caller, detected before a byte was sent.

    The text is ``ARGUMENT is VALUE; allowed: ALLOWED`` for a bad value. For everything else (a file
    that does not exist, a missing argument or package) ``message`` is the whole text.

    Attributes:
        argument: the argument at fault, for example ``angles[2]``.
        value: the value that was given; None if the error is not about a value.
        allowed: the allowed values in words; empty if the error is not about a value.
    """

    def __init__(
        self, argument: str, value: Any = None, allowed: str = "", *, message: str = ""
    ) -> None:
        self.argument = argument
        self.value = value
        self.allowed = allowed
        super().__init__(
            message or error_text("value", argument=argument, value=_short(value), allowed=allowed)
        )

    def renamed(self, names: Mapping[str, str]) -> UsageError:
        """Return the error for an interface that has other names for some arguments.

        ``names`` maps our names to these names. The name of an element, as in ``coords.x``, stays.
        """
        argument = _FIRST_NAME.sub(lambda found: names.get(found[0], found[0]), self.argument)
        usual = str(UsageError(self.argument, self.value, self.allowed))
        message = "" if str(self) == usual else str(self)
        return UsageError(argument, self.value, self.allowed, message=message)


class UnreadableInput(UsageError):
    """An error of an input file: it is empty, in an unknown format, or wrong in one of its lines.

    Attributes:
        name: the name of the file.
        line: the number of the line at fault; 0 if the error is about the whole file.
        detail: what is wrong.
    """

    def __init__(self, name: str, detail: str, line: int = 0) -> None:
        self.name, self.line, self.detail = name, line, detail
        super().__init__("FILE", name, message=f"{name}{f':{line}:' * bool(line)} {detail}")


class EmptyInput(UnreadableInput):
    """An error of an input file: it is empty, or it is a recording without packets."""

    def __init__(self, name: str) -> None:
        super().__init__("standard input" if name == "-" else name, "is empty")


class ProtocolError(CobotwireError):
    """An error of the peer: bytes that the protocol does not allow.

    Attributes:
        reason: a code for programs: a noise reason, ``bad-value``, ``trailing`` or ``bad-text``.
        offset: the index of the wrong byte in ``data``.
        data: the rejected bytes.
        detail: what is wrong, without the offset and the bytes.
    """

    def __init__(self, reason: str, offset: int, data: bytes, detail: str) -> None:
        self.reason = reason
        self.offset = offset
        self.data = data
        self.detail = detail
        shown = data.hex(" ").upper() or error_text("no-bytes")
        super().__init__(error_text("protocol", detail=detail, offset=offset, data=shown))


class RequestRefused(ProtocolError):
    """The device replied that it does not carry out a request, or that a motion has failed.

    Attributes:
        request: the call with its arguments.
        field: the field of the reply that holds the status.
        status: the status: its name in the edition with its number, such as ``NO_POWER (3)``.
    """

    def __init__(self, request: str, field: str, status: str, data: bytes) -> None:
        self.request = request
        self.field = field
        self.status = status
        detail = error_text("refused", request=request, field=field, status=status)
        super().__init__("rejected", 0, data, detail)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.request, self.field, self.status, self.data)


class LinkError(CobotwireError, OSError):
    """An error of the transport: the port could not be opened, or it disappeared.

    Attributes:
        url: the port or URL.
        detail: what happened.
        written: the number of bytes of the request that were written before the write failed; None
            if it is not known.
    """

    def __init__(self, url: str, detail: str, written: int | None = 0) -> None:
        self.url = url
        self.detail = detail
        self.written = written
        super().__init__(error_text("link", url=url, detail=detail))


WaitedFor = Literal["turn", "hold", "line", "reply"]
# The start of the line of text that a simulated arm sends instead of a reply that it cannot make.
SIMULATED = "simulated arm: "


class ReplyTimeout(CobotwireError, TimeoutError):
    """The reply, or the requested acknowledgement, did not arrive in time.

    Attributes:
        command: the name of the command.
        waited: seconds from the request to the error; from the call, if its deadline passed.
        received: what was received instead, one line each.
        attempts: how often the request was sent; 0 if it was not sent, and never will be.
        request: the call with its arguments, for example ``get_encoder(joint=1)``.
        waited_for: what the call waited for when the ``deadline`` of the client passed: ``turn``,
            ``hold``, ``line`` or ``reply``; empty if another timeout passed, of the reply or of
            the reading before a request.
        refusal: why a simulated arm cannot reply, even if the request is sent again; empty if the
            arm did not report that.
    """

    def __init__(
        self,
        command: str,
        waited: float,
        received: tuple[str, ...],
        attempts: int = 1,
        request: str = "",
        waited_for: WaitedFor | None = None,
    ) -> None:
        self.command = command
        self.waited = waited
        self.received = received
        self.attempts = attempts
        self.request = request or command
        self.waited_for = waited_for or ""
        meanwhile = "; ".join(received) if received else error_text("nothing")
        found = re.search(f"{SIMULATED}([^']+)", meanwhile)
        self.refusal = found[1] if found else ""
        what = error_text(
            f"{'no-reply' if attempts else 'not-sent'}{'-by-deadline' * bool(waited_for)}",
            request=self.request,
            waited=f"{waited:.3f}",
            attempts=error_text("attempt" if attempts == 1 else "attempts", count=attempts),
            meanwhile=error_text(waited_for or "nothing"),
        )
        if waited_for is None or attempts:
            kind = "simulated" if self.refusal else "meanwhile"
            what = error_text(kind, what=what, refusal=self.refusal, received=meanwhile)
        super().__init__(what)


class EditionUnknown(CobotwireError):
    """No arm replied, or its replies do not show which edition it speaks.

    Attributes:
        url: the port.
        evidence: each query that was sent, and what happened.
        candidates: the editions that the replies allow; empty without a reply.
    """

    def __init__(
        self, url: str, evidence: tuple[str, ...], candidates: tuple[str, ...] = ()
    ) -> None:
        self.url = url
        self.evidence = evidence
        self.candidates = candidates
        allowed = f" Its replies allow {', '.join(candidates)}." if candidates else ""
        super().__init__(
            f"{url}: the edition of the arm is not known ({'; '.join(evidence)}); check the port "
            "with cobotwire doctor, or open it with the client of an edition, such as MyCobot280."
            f"{allowed}"
        )


class ArmState(NamedTuple):
    """What an arm reported about itself; None where it did not reply, or cannot report it.

    Attributes:
        position: its angles or coordinates, of the same kind as the target.
        powered: whether it has power; in some editions a member of ``PowerState``.
        paused: whether its motion is paused.
        error: its error register.
        error_meaning: what the number in the error register means; empty if that is not known.
    """

    position: tuple[float, ...] | None = None
    powered: int | None = None
    paused: bool | None = None
    error: int | None = None
    error_meaning: str = ""

    def sentences(self) -> list[str]:
        """Return reported facts that explain why an arm is not at its target."""
        found = []
        if self.position is not None:
            found.append(f"it is at {list(self.position)}")
        if self.powered is not None and not self.powered:
            found.append(f"it has {no_power(self.powered)}")
        if self.paused:
            found.append("its motion is paused")
        if self.error:
            found.append(f"its error register is {with_meaning(self.error, self.error_meaning)}")
        return found


def no_power(powered: int) -> str:
    """Return in words that an arm has no power; ``powered`` is the false value that it reports."""
    name = getattr(powered, "name", "") if powered != 0 else ""
    return f"no power: it reports {name}" if name else "no power"


def with_meaning(number: int, meaning: str) -> str:
    """Return a number of the error register, and what it means if that is known."""
    return f"{number}: {meaning}" if meaning else f"{number}, which no source explains"


UNKNOWN = ArmState()


class MotionTimeout(CobotwireError, TimeoutError):
    """The arm did not reach its target in time, or it stopped short of the target.

    Attributes:
        target: the target of the motion.
        waited: seconds from the start of the wait to the error.
        standing: whether the arm stood still at the end; False if this is not known.
        stopped: whether the client then sent ``stop``; see ``on_error`` of the client.
        state: what the arm reported about itself after that.
    """

    def __init__(
        self,
        target: tuple[float, ...],
        waited: float,
        standing: bool,
        stopped: bool = False,
        state: ArmState = UNKNOWN,
    ) -> None:
        self.target = target
        self.waited = waited
        self.standing = standing
        self.stopped = stopped
        self.state = state
        how = "stands still short of" if standing else "has not reached"
        first = f"the arm {how} {list(target)} after {waited:.1f} s"
        sent = ["stop was sent"] if stopped else []
        super().__init__("; ".join([first, *state.sentences(), *sent]))


class FollowFailed(CobotwireError, TimeoutError):
    """The arm did not follow its path to the end.

    Attributes:
        report: how far it came: a :class:`~cobotwire.session.paths.FollowReport`.
    """

    def __init__(self, why: str, report: Any) -> None:
        self.report = report
        super().__init__(f"{why}, {report}")


class ArmNotReady(CobotwireError):
    """The arm reports that it does not obey a motion.

    Attributes:
        command: the name of the command.
        sent: whether the motion was sent; the arm then reported why it rejected the motion.
        problems: what the arm reports, and what to do about it, a sentence each.
    """

    def __init__(self, command: str, sent: bool, problems: tuple[str, ...]) -> None:
        self.command = command
        self.sent = sent
        self.problems = problems
        how = "was sent, but" if sent else "was not sent:"
        super().__init__(f"{command} {how} {'. Also, '.join(problems)}")


class CaptureError(CobotwireError, ValueError):
    """An error in a recording: it is not a pcapng file, is damaged, or cannot be completed.

    Attributes:
        name: the name of the file.
        offset: the offset of the faulty block in the file, in bytes.
        detail: what is wrong.
    """

    def __init__(self, name: str, offset: int, detail: str) -> None:
        self.name = name
        self.offset = offset
        self.detail = detail
        super().__init__(f"{name}: {detail} (at byte {offset})")


class OutputError(CobotwireError, OSError):
    """An error of the system while it writes the files of an export, such as a full disk.

    No file with a final name is incomplete: what was written had a temporary name, and is removed.

    Attributes:
        path: the file.
        detail: what happened.
    """

    def __init__(self, path: str, detail: str) -> None:
        self.path = path
        self.detail = detail
        super().__init__(f"{path}: writing failed: {detail}; nothing was exported")


class ScenarioError(CobotwireError, ValueError):
    """An error in a scenario file.

    Attributes:
        problems: every problem in the order of the file, each as ``file:line:column: what``.
    """

    def __init__(self, problems: Sequence[str]) -> None:
        self.problems = tuple(problems)
        super().__init__(*self.problems)


class StatementError(CobotwireError, ValueError):
    """An error in an implementation conformance statement.

    Attributes:
        problems: every problem in the order of the file, each as ``file:line:column: what``.
    """

    def __init__(self, problems: Sequence[str]) -> None:
        self.problems = tuple(problems)
        super().__init__(*self.problems)


def _short(value: Any, limit: int = 80) -> str:
    try:
        text = repr(value)
    # Python writes no whole number of more than 4300 digits, and no list that is nested too deeply.
    except (ValueError, RecursionError):
        return error_text("too-long", type=type(value).__name__)
    return text if len(text) <= limit else text[: limit - 3] + "..."
