"""Define wire types: how raw values are encoded as bytes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cobotwire_codegen.errors import Place
from cobotwire_codegen.model import floats
from cobotwire_codegen.model.facts import Dispute, Lines


@dataclass(frozen=True, slots=True)
class Wire:
    """How a raw value is encoded."""

    place: Place
    name: str
    width: int
    order: Literal["big", "little"]
    signed_at: int
    doc: str
    source: Lines
    disputed: tuple[Dispute, ...]
    encoding: Literal["integer", "float"] = "integer"

    @property
    def is_float(self) -> bool:
        """Whether it is an IEEE float; then a raw value is the rank of the float (`floats`)."""
        return self.encoding == "float"

    @property
    def minimum(self) -> int:
        """The lowest raw value; for a float, the raw value of the lowest finite float."""
        if self.is_float:
            return -1 - floats.largest_rank(self.width)
        return self.signed_at + 1 - 256**self.width if self.signed_at < self.top else 0

    @property
    def maximum(self) -> int:
        """The highest raw value; for a float, the raw value of the highest finite float."""
        return floats.largest_rank(self.width) if self.is_float else self.signed_at

    def raw_of(self, data: bytes) -> int:
        """Return the raw value that bytes encode."""
        word = int.from_bytes(data, self.order)
        if self.is_float:
            half = 256**self.width // 2
            return word if word < half else half - 1 - word
        return word if word <= self.signed_at else word - int(256**self.width)

    def bytes_of(self, raw: int) -> bytes:
        """Return the bytes that encode a raw value."""
        word = 256**self.width // 2 - 1 - raw if self.is_float and raw < 0 else raw
        return int(word % 256**self.width).to_bytes(self.width, self.order)

    @property
    def top(self) -> int:
        """The highest unsigned number of this width."""
        return int(256**self.width) - 1
