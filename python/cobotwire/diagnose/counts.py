"""Count the frames, noise and findings of streams."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

from cobotwire.codec.interface import Counters, Frame
from cobotwire.diagnose.explain import FrameReader
from cobotwire.protocol.table import Command

if TYPE_CHECKING:
    from cobotwire.diagnose.diagnoser import Item
    from cobotwire.diagnose.stream_summary import StreamSummary
    from cobotwire.diagnose.summary import Summary


class Framed(Protocol):
    """A framer, or an object with the counters of one."""

    @property
    def counters(self) -> Counters:
        """The counts of the framer."""
        ...


class StreamCounts:
    """Counts what streams hold; its memory does not grow with them.

    Attributes:
        framers: the framers of the counted streams; their counters are part of the result.
        frames: the number of frames by id and name of the command.
    """

    def __init__(self) -> None:
        self.framers: list[Framed] = []
        self.frames: Counter[str] = Counter()
        self._illegal = 0

    @cached_property
    def findings(self) -> Summary:
        """The findings, counted by kind."""
        # Imported here: few streams have noise, and its classes take long to load.
        from cobotwire.diagnose.summary import Summary

        return Summary()

    @property
    def only_legal(self) -> bool:
        """Return whether there was nothing but legal frames."""
        return not self.noise and not self._illegal

    @property
    def noise(self) -> Counter[str]:
        """Return the bytes of noise by the framer's reason."""
        noise: Counter[str] = Counter()
        for framer in self.framers:
            noise.update(framer.counters.noise)
        return noise

    @property
    def bytes(self) -> int:
        """Return the number of bytes."""
        return sum(framer.counters.bytes for framer in self.framers)

    @property
    def resyncs(self) -> int:
        """Return how often a frame followed noise."""
        return sum(framer.counters.resyncs for framer in self.framers)

    def add(self, items: Iterable[Item], reader: FrameReader) -> None:
        """Count frames by name, and findings by kind."""
        for item in items:
            if isinstance(item, Frame):
                self._add_frame(item, reader)
            else:
                self.findings.add(item)

    def _add_frame(self, frame: Frame, reader: FrameReader) -> None:
        readings = reader.read(frame.data)
        message = readings[0].message if readings else None
        self._count(frame.command, None if message is None else message.command, 1)

    def _count(self, id: int, command: Command | None, count: int) -> None:
        self._illegal += count if command is None else 0
        name = "illegal value or unknown id" if command is None else command.name
        self.frames[f"0x{id:02X} {name}"] += count

    def add_findings(self, items: Iterable[Item]) -> None:
        """Count the findings by kind, but not the frames, which :meth:`add_summary` counts."""
        for item in items:
            if not isinstance(item, Frame):
                self.findings.add(item)

    def add_summary(self, summary: StreamSummary) -> None:
        """Count what a summary has counted; once, after all its findings."""
        self.framers.append(summary.native)
        for id, command, count in summary.native.messages:
            self._count(id, command, count)
        for kind, count, size in summary.native.findings:
            self.findings.add_more(kind, count, size)

    def as_dict(self) -> dict[str, Any]:
        """Return all counts by name."""
        return {
            "bytes": self.bytes,
            "frames": dict(self.frames),
            "noise": dict(self.noise),
            "findings": dict(self.findings.kinds),
            "resyncs": self.resyncs,
            "diagnosis": str(self.findings),
        }
