"""Which reply answered which question, and after how long, in a recording."""

from __future__ import annotations

from dataclasses import dataclass, field

from cobotwire.table import Table


@dataclass
class Replies:
    """Seconds are those of the recording, as it begins.

    Attributes:
        taken: when a question was sent, and how many seconds its reply took.
        late: those of them that took longer than the edition gives the command.
        missing: when questions were sent that nothing answered.
    """

    taken: list[tuple[float, float]] = field(default_factory=list)
    late: list[tuple[float, float]] = field(default_factory=list)
    missing: list[float] = field(default_factory=list)


class Pairing:
    """A reply belongs to the newest question of its id: the protocol numbers nothing.

    A question that is asked again before its answer has come counts as one without a reply, and a
    late reply for the question that was asked last.
    """

    def __init__(self, table: Table) -> None:
        self.replies = Replies()
        self._asking = {c.id: c.deadline_ms / 1000 for c in table.commands if c.answers}
        self._open: dict[int, float] = {}

    def sent(self, at: float, id: int) -> None:
        """A request went out."""
        if id in self._asking:
            if id in self._open:
                self.replies.missing.append(self._open[id])
            self._open[id] = at

    def heard(self, at: float, id: int) -> None:
        """A frame came."""
        asked = self._open.pop(id, None)
        if asked is None:
            return
        self.replies.taken.append((asked, at - asked))
        if at - asked > self._asking[id]:
            self.replies.late.append((asked, at - asked))

    def end(self) -> Replies:
        """Nothing more comes."""
        self.replies.missing += self._open.values()
        self._open.clear()
        self.replies.missing.sort()
        return self.replies
