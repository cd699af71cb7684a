"""Survey a whole stream: only rare noise and illegal frames become Python objects.

:class:`~cobotwire.diagnose.diagnoser.Diagnoser` diagnoses any stream. This module does the same for
captures, hundreds of times as fast: the native codec counts the messages and the frequent classes
of noise, and writes the lines of ``cobotwire decode --json``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from cobotwire.codec.interface import Codec, Event, Frame, Listening, Noise
from cobotwire.diagnose.diagnoser import REACH, Diagnoser, Item
from cobotwire.diagnose.servo import servo_bus

if TYPE_CHECKING:
    from cobotwire.codec.native import NativeSurvey


class LineTexts(NamedTuple):
    """The texts of the lines, in JSON.

    Attributes:
        first: follows the brace that starts a line: nothing, or a key with its value and a comma.
        commands: the names of all commands.
        requests: the names of the fields, by command, variant and field.
        replies: those of the replies.
        unrecognised: the text of unrecognised bytes.
        command_error: the text of the firmware's error message.
    """

    first: str
    commands: list[str]
    requests: list[list[list[str]]]
    replies: list[list[list[str]]]
    unrecognised: str
    command_error: str


class Lines(Frame):
    """The lines of a part of the stream that needs no diagnosis; each ends with a line feed."""

    __slots__ = ("text",)

    def __init__(self, offset: int, size: int, text: str) -> None:
        # For the diagnosis only the number of bytes counts, and whether it is more than its reach.
        super().__init__(offset, bytes(min(size, REACH + 1)), 0)
        self.text = text


class StreamSurvey:
    """Surveys a stream: counts everything, and returns what Python has to look at.

    Attributes:
        native: the counts.
    """

    def __init__(
        self,
        codec: Codec,
        listening: Listening,
        *,
        accept_unknown: bool = False,
        texts: LineTexts | None = None,
    ) -> None:
        self.native = _native(codec, listening, accept_unknown, texts)
        self._diagnoser = Diagnoser(codec, listening)
        self._read_id = codec.table.frame.read_id

    @staticmethod
    def reads(codec: Codec) -> bool:
        """Return whether streams of a codec can be surveyed."""
        return codec.name == "native" and codec.table.frame.reply_has_id

    def feed(self, data: bytes) -> list[Item]:
        """Take bytes; return lines, findings and illegal frames, in the order of the stream."""
        return self._items(self.native.feed(data))

    def flush(self) -> list[Item]:
        """Return the rest, because no more bytes follow."""
        return self._items(self.native.flush())

    def _items(self, parts: list[Noise | tuple[Any, ...] | None]) -> list[Item]:
        items: list[Item] = []
        events: list[Event] = []
        for part in parts:
            if part is None:
                items += self._diagnoser.feed(events) + self._diagnoser.flush()
                events.clear()
            else:
                events.append(part if isinstance(part, Noise) else self._frame(*part))
        return items + self._diagnoser.feed(events)

    def _frame(self, offset: int, *rest: Any) -> Frame:
        if len(rest) > 1:
            return Lines(offset, *rest)
        (data,) = rest
        return Frame(offset, data, self._read_id(data))


def _native(
    codec: Codec, listening: Listening, accept_unknown: bool, texts: LineTexts | None
) -> NativeSurvey:
    from cobotwire.codec.native import NativeCodec, NativeSurvey

    assert isinstance(codec, NativeCodec), "reads() tells whether a codec has a survey"
    bus = servo_bus()
    return NativeSurvey(codec, listening, accept_unknown, bus.table.frame, bus.lengths, texts)
