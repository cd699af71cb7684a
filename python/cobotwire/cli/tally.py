"""What ``cobotwire decode --summary`` counts."""

from __future__ import annotations

import json
from collections import Counter

from cobotwire.cli.show import Reader
from cobotwire.codec.interface import Frame, Framer
from cobotwire.diagnose import Item, Summary


class Tally:
    """Counts of a stream; small, however long that is."""

    def __init__(self, framers: list[Framer]) -> None:
        self._framers = framers
        self._frames: Counter[str] = Counter()
        self._illegal = 0
        self._findings = Summary()

    @property
    def clean(self) -> bool:
        """Whether there was nothing but legal frames."""
        return not self._noise() and not self._illegal

    def count(self, items: list[Item], read: Reader) -> list[Item]:
        """Count frames by name, and findings; give them back."""
        for item in items:
            self._count_item(item, read)
        return items

    def _noise(self) -> Counter[str]:
        noise: Counter[str] = Counter()
        for framer in self._framers:
            noise.update(framer.counters.noise)
        return noise

    def _count_item(self, item: Item, read: Reader) -> None:
        if not isinstance(item, Frame):
            self._findings.add(item)
            return
        found = read(item.data)
        message = found[0].message if found else None
        self._illegal += message is None
        name = "illegal value or unknown id" if message is None else message.command.name
        self._frames[f"0x{item.command:02X} {name}"] += 1

    @property
    def _bytes(self) -> int:
        return sum(framer.counters.bytes for framer in self._framers)

    @property
    def _resyncs(self) -> int:
        return sum(framer.counters.resyncs for framer in self._framers)

    def lines(self) -> str:
        """The counts for people."""
        noise = self._noise()
        lines = [f"{self._bytes} bytes, {self._frames.total()} frames, {self._resyncs} resyncs"]
        lines += [f"  {count:>10} x {name}" for name, count in self._frames.most_common()]
        lines.append(f"{noise.total()} bytes of noise")
        lines += [f"  {count:>10} {reason}" for reason, count in noise.most_common()]
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
                "noise": dict(self._noise()),
                "findings": dict(self._findings.kinds),
                "resyncs": self._resyncs,
                "diagnosis": str(self._findings),
            }
        )
