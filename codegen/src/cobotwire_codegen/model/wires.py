"""Define wire types: how raw values are encoded as bytes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from cobotwire_codegen.encodings import ENCODINGS, Encoding
from cobotwire_codegen.errors import Place
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
    encoding: str = "integer"

    @property
    def rule(self) -> Encoding:
        """The rule of its encoding."""
        return ENCODINGS[self.encoding]

    @property
    def is_float(self) -> bool:
        """Whether it is an IEEE float; then a raw value is the rank of the float (`floats`)."""
        return self.encoding == "float"

    @property
    def form(self) -> dict[str, Any]:
        """Its record in tables and ``edition.json``; that of an integer has no ``encoding``."""
        encoding = {} if self.encoding == "integer" else {"encoding": self.encoding}
        form = {"width": self.width, "order": self.order, "signed_at": self.signed_at}
        return form | encoding

    @property
    def minimum(self) -> int:
        """The lowest raw value; for a float, the raw value of the lowest finite float."""
        return self.rule.bounds(self.width, self.signed_at)[0]

    @property
    def maximum(self) -> int:
        """The highest raw value; for a float, the raw value of the highest finite float."""
        return self.rule.bounds(self.width, self.signed_at)[1]

    def raw_of(self, data: bytes) -> int:
        """Return the raw value that bytes encode."""
        return self.rule.raw_of(int.from_bytes(data, self.order), self.width, self.signed_at)

    def bytes_of(self, raw: int) -> bytes:
        """Return the bytes that encode a raw value."""
        unsigned = self.rule.unsigned_of(raw, self.width) % 256**self.width
        return int(unsigned).to_bytes(self.width, self.order)

    @property
    def top(self) -> int:
        """The highest unsigned number of this width."""
        return int(256**self.width) - 1
