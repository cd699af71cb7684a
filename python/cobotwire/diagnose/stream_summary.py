"""Summarize a whole stream: only rare noise becomes Python objects.

:class:`~cobotwire.diagnose.diagnoser.Diagnoser` diagnoses any stream. This module does the same for
captures, hundreds of times as fast: the native codec counts the messages and the frequent classes
of noise, and writes the lines of ``cobotwire decode --json``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from cobotwire.codec.interface import Codec, Frame, Listening, Noise, NoiseReason
from cobotwire.diagnose import garbage, nuls
from cobotwire.diagnose.damaged import DamagedFrames
from cobotwire.diagnose.diagnoser import REACH, Diagnoser, Item
from cobotwire.diagnose.findings import Finding, Span
from cobotwire.diagnose.firmware import CommandError
from cobotwire.diagnose.frames import Frames
from cobotwire.diagnose.servo import Expected, ServoBus, servo_bus

if TYPE_CHECKING:
    from cobotwire.codec.native import NativeSummary

# The native summary returns noise to diagnose, and lines as (offset, size, text).
Part = Noise | tuple[int, int, str]


class LineTexts(NamedTuple):
    """The texts of the lines, in JSON.

    Attributes:
        first: follows the brace that starts a line: nothing, or a key with its value and a comma.
        commands: the names of all commands.
        requests: the names of the fields of requests, by command, variant and field.
        replies: the names of the fields of replies, likewise.
        describe: returns the text and the facts of a finding, as two members of an object.
    """

    first: str
    commands: list[str]
    requests: list[list[list[str]]]
    replies: list[list[list[str]]]
    describe: Callable[[Finding], str]


class Lines(Frame):
    """The lines of a part of the stream that needs no diagnosis; each ends with a line feed."""

    __slots__ = ("text",)

    def __init__(self, offset: int, size: int, text: str) -> None:
        # The diagnosis only counts these bytes, and treats all counts above REACH alike.
        super().__init__(offset, bytes(min(size, REACH + 1)), 0)
        self.text = text


class StreamSummary:
    """Summarizes a stream: counts everything, and returns what Python must diagnose.

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
        self._rest = Rest(codec, listening, texts)

    @staticmethod
    def reads(codec: Codec) -> bool:
        """Return whether streams of a codec can be summarized."""
        return codec.name == "native" and codec.table.frame.reply_has_id

    def feed(self, data: bytes) -> list[Item]:
        """Take bytes; return lines and findings, in the order of the stream."""
        return self._rest.taken(self.native.feed(data, self._rest))

    def flush(self) -> list[Item]:
        """Return the rest, because no more bytes follow."""
        return self._rest.taken(self.native.flush(self._rest))


class Rest:
    """Does what the native summary leaves to Python; the native summary calls it.

    It diagnoses noise of rare classes, and describes noise that has few different descriptions.
    """

    def __init__(self, codec: Codec, listening: Listening, texts: LineTexts | None) -> None:
        self._texts = texts
        self._diagnoser = Diagnoser(codec, listening)
        self._damaged_frames = self._diagnoser.recogniser(DamagedFrames)
        self._frames = self._diagnoser.recogniser(Frames)
        self._bus = self._diagnoser.recogniser(ServoBus)
        self._items: list[Item] = []

    def diagnose(self, parts: list[Part], closed: bool, expected: Expected) -> Expected:
        """Diagnose the noise in ``parts``; if ``closed``, no later noise belongs to it.

        ``expected`` is what the servo bus expects after the packets before this noise. Return what
        it expects after the noise.
        """
        self._bus.expected = expected
        self._add(parts)
        if closed:
            self._items += self._diagnoser.flush()
        return self._bus.expected

    def taken(self, parts: list[Part]) -> list[Item]:
        """Return all items that are certain, with those of ``parts``, which come last."""
        self._add(parts)
        items, self._items = self._items, []
        return items

    def _add(self, parts: list[Part]) -> None:
        events = [part if isinstance(part, Noise) else Lines(*part) for part in parts]
        self._items += self._diagnoser.feed(events)

    def describe(self, kind: str, reason: NoiseReason, data: bytes, id: int | None) -> str:
        """Return text and facts of noise that the native summary has found."""
        assert self._texts is not None, "a summary without lines describes nothing"
        return self._texts.describe(self._finding(kind, reason, data, id))

    def _finding(self, kind: str, reason: NoiseReason, data: bytes, id: int | None) -> Finding:
        spans = (Span(0, data),)
        match kind:
            case "damaged-frame":
                return self._damaged_frames.damaged(spans, reason, id)
            case "opposite-frame":
                return self._frames.opposite(spans, reason)
            case "unlisted-frame":
                return self._frames.unlisted(spans, reason)
            case "nuls":
                return nuls.nuls(spans, reason)
            case "cmd-len-error":
                return CommandError(spans=spans, reason=reason)
            case _:
                return garbage.classify(spans, reason)


def _native(
    codec: Codec, listening: Listening, accept_unknown: bool, texts: LineTexts | None
) -> NativeSummary:
    from cobotwire.codec.native import NativeCodec, NativeSummary

    assert isinstance(codec, NativeCodec), "reads() tells whether a codec has a summary"
    names = None if texts is None else texts[:4]
    return NativeSummary(codec, listening, accept_unknown, servo_bus().vocabulary, names)
