"""Answers that are still owed: to questions that were given up, or asked more than once.

The protocol has no sequence numbers, so an answer that comes late looks just like the answer to the
next question of the same command. Hence that question waits until the old answer has come, or has
had its time.
"""

from __future__ import annotations

from typing import NamedTuple

from cobotwire.codec.interface import Codec, Frame
from cobotwire.errors import ProtocolError
from cobotwire.session.request import Request, fits, told_apart


class _Debt(NamedTuple):
    request: Request
    until: float


class Debts:
    """What is owed; a few entries at most, since each is forgotten when it has had its time."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._debts: list[_Debt] = []

    def owe(self, request: Request, until: float) -> None:
        """An answer to this request may still come until then."""
        self._debts.append(_Debt(request, until))

    def forget(self, now: float) -> None:
        """Drop what has had its time."""
        if self._debts:
            self._debts = [debt for debt in self._debts if debt.until > now]

    def hold_until(self, request: Request) -> float | None:
        """Until when an owed answer could be taken for this request's; None: none could."""
        if not self._debts or not request.command.answers:
            return None
        alike = (d.until for d in self._debts if not told_apart(d.request, request))
        return max(alike, default=None)

    def any_of(self, command: int) -> bool:
        """Whether an answer with this id is owed."""
        return any(debt.request.command.id == command for debt in self._debts)

    def settle(self, frame: Frame) -> Request | None:
        """A frame came that answers nothing that waits: is it what is owed? Oldest first."""
        for index, debt in enumerate(self._debts):
            if debt.request.command.id == frame.command and self._pays(frame, debt.request):
                del self._debts[index]
                return debt.request
        return None

    def _pays(self, frame: Frame, request: Request) -> bool:
        if frame.data == request.frame:
            # Perhaps only the line's echo of the question: the answer may be still to come.
            return False
        try:
            return fits(self._codec.decode("reply", frame.data, of=request.command.name), request)
        except ProtocolError:
            return False
