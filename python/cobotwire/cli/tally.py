"""What ``cobotwire decode --summary`` counts."""

from __future__ import annotations

import json
from collections import Counter

from cobotwire.cli.show import Reader
from cobotwire.codec.interface import Frame, Framer
from cobotwire.diagnose import Item, Summary


class Tally:
    """Counts of a stream; small, however long that is."""

    def __init__(self, read: Reader, framer: Framer) -> None:
        self._read = read
        self._framer = framer
        self._frames: Counter[str] = Counter()
        self._illegal = 0
        self._findings = Summary()

    @property
    def clean(self) -> bool:
        """Whether there was nothing but legal frames."""
        return not self._framer.counters.noise and not self._illegal

    def count(self, items: list[Item]) -> list[Item]:
        """Count frames by name, and findings; give them back."""
        for item in items:
            self._count_item(item)
        return items

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
        counters, noise = self._framer.counters, Counter(self._framer.counters.noise)
        frames = f"{self._frames.total()} frames, {counters.resyncs} resyncs"
        lines = [f"{counters.bytes} bytes, {frames}"]
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
        counters = self._framer.counters
        return json.dumps(
            {
                "kind": "summary",
                "bytes": counters.bytes,
                "frames": dict(self._frames),
                "noise": dict(counters.noise),
                "findings": dict(self._findings.kinds),
                "resyncs": counters.resyncs,
                "diagnosis": str(self._findings),
            }
        )
