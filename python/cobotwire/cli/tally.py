"""What ``cobotwire decode --summary`` counts."""

from __future__ import annotations

import json
from collections import Counter

from cobotwire.cli.show import Reader
from cobotwire.codec.interface import Event, Frame, Noise
from cobotwire.diagnose import Item, Summary


class Tally:
    """Counts of a stream; small, however long that is."""

    def __init__(self, read: Reader) -> None:
        self._read = read
        self._bytes = 0
        self._frames: Counter[str] = Counter()
        self._illegal = 0
        self._noise: Counter[str] = Counter()
        self._resyncs = 0
        self._in_noise = False
        self._findings = Summary()

    @property
    def clean(self) -> bool:
        """Whether there was nothing but legal frames."""
        return not self._noise and not self._illegal

    def count(self, events: list[Event], items: list[Item]) -> list[Item]:
        """Count what the framer gave and what became of it; give the latter back."""
        self._count_events(events)
        for item in items:
            self._count_item(item)
        return items

    def _count_events(self, events: list[Event]) -> None:
        for event in events:
            self._bytes += len(event.data)
            if isinstance(event, Noise):
                self._noise[event.reason] += len(event.data)
            elif self._in_noise:
                self._resyncs += 1
            self._in_noise = isinstance(event, Noise)

    def _count_item(self, item: Item) -> None:
        if not isinstance(item, Frame):
            self._findings.add(item)
            return
        found = self._read(item.data)
        message = found[0].message if found else None
        self._illegal += message is None
        name = "illegal value or unknown id" if message is None else message.command.name
        self._frames[f"0x{item.command:02X} {name}"] += 1

    def lines(self) -> str:
        """The counts for people."""
        lines = [f"{self._bytes} bytes, {self._frames.total()} frames, {self._resyncs} resyncs"]
        lines += [f"  {count:>10} x {name}" for name, count in self._frames.most_common()]
        lines.append(f"{self._noise.total()} bytes of noise")
        lines += [f"  {count:>10} {reason}" for reason, count in self._noise.most_common()]
        lines.append(f"{self._findings.kinds.total()} findings")
        lines += [f"  {count:>10} x {kind}" for kind, count in self._findings.kinds.most_common()]
        return "\n".join(
            [*lines, *([f"diagnosis: {said}"] if (said := str(self._findings)) else [])]
        )

    def as_json(self) -> str:
        """The counts as one JSON object."""
        return json.dumps(
            {
                "kind": "summary",
                "bytes": self._bytes,
                "frames": dict(self._frames),
                "noise": dict(self._noise),
                "findings": dict(self._findings.kinds),
                "resyncs": self._resyncs,
                "diagnosis": str(self._findings),
            }
        )
