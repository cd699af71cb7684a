"""Define what a recogniser is: it finds classes of noise in the bytes that are not frames."""

from __future__ import annotations

from cobotwire.codec.interface import Codec, Listening
from cobotwire.diagnose.findings import Finding
from cobotwire.diagnose.residue import Residue, Verdict


class Recogniser:
    r"""Recognises one or more classes of noise. Each stream has its own recognisers.

    ``starts`` is a regular expression for the offsets where :meth:`recognise` may find something.
    Where more bytes could complete a start, it also matches at the end of the bytes (``\Z``).
    """

    starts: bytes

    def __init__(self, codec: Codec, listening: Listening) -> None:
        """Prepare for a stream of ``codec``; its framer listens to ``listening``."""

    def recognise(self, residue: Residue, at: int) -> Verdict:
        """Return what starts at ``at``; a match of ``starts`` can begin with the byte there."""
        raise NotImplementedError

    def sent(self, data: bytes) -> None:
        """Note a request that was sent."""

    def found(self, finding: Finding) -> None:
        """Note a finding of any class; findings come in the order of the stream."""
