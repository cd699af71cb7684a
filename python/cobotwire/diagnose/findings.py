"""Define what a finding is: noise that belongs together, with its offset, facts and description."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, ClassVar, NamedTuple

from cobotwire.codec.interface import NoiseReason
from cobotwire.protocol.counted import counted

# The number of characters of a text that are shown.
SHOWN = 60
CHECK_CONTROLLER = (
    "the controller's program or its power failed: check the power supply and its plug, then "
    "update the firmware"
)


class Span(NamedTuple):
    """Consecutive bytes of the stream; ``offset`` is where they start in it."""

    offset: int
    data: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """Noise that belongs together. Each class of noise is a subclass, listed in ``registry``.

    There are several ``spans`` if frames interrupt the noise. ``reason`` is the framer's reason for
    the first byte. ``continued`` marks the next piece of noise that was too long for one finding.

    Attributes of the class:
        kind: the name of the class of noise.
        advice: what the user should do about it.
        serious: whether it is a fault, not only worth knowing.
        piece: the size of a full piece; None if the noise is not split into pieces.
        readable: whether it is text, so that even a short text after it is recognised.
    """

    spans: tuple[Span, ...]
    reason: NoiseReason
    continued: bool = False
    kind: ClassVar[str]
    advice: ClassVar[str]
    serious: ClassVar[bool] = True
    piece: ClassVar[int | None] = None
    readable: ClassVar[bool] = False
    # How a summary names several findings of the kind: ``PREFIX 3 NOUN, e.g. EXAMPLE``.
    summary_prefix: ClassVar[str] = ""
    summary_noun: ClassVar[str] = ""

    @property
    def offset(self) -> int:
        """Return the offset of the first byte in the stream."""
        return self.spans[0].offset

    @property
    def data(self) -> bytes:
        """Return the bytes, without the frames that interrupt them."""
        return b"".join(span.data for span in self.spans)

    @property
    def failure(self) -> str | None:
        """Return why the controller failed, "" if unknown; None: this is no sign of a failure."""
        return None

    @property
    def reboots(self) -> bool:
        """Return whether the controller reboots, if the finding is a sign of a failure."""
        return True

    @property
    def ordinary(self) -> bool:
        """Return whether a working arm sends it, too."""
        return False

    def describe(self) -> str:
        """Describe the finding on one line."""
        return self.kind

    def example(self) -> str:
        """Describe the finding as an example in a summary."""
        return self.describe()

    def summarize(self, count: int, size: int) -> str:
        """Describe ``count`` findings of this class, of ``size`` bytes; this is the first."""
        if count == 1:
            return f"{self.summary_prefix}{self.example()}"
        counts = counted(count, self.summary_noun)
        return f"{self.summary_prefix}{counts}, e.g. {self.example()}"

    @property
    def facts(self) -> dict[str, Any]:
        """Return the attributes that are specific to the kind, by name."""
        common = len(fields(Finding))
        return {field.name: getattr(self, field.name) for field in fields(self)[common:]}
