"""A right device on a line that is not quite clean: what the servos say leaks between frames."""

from __future__ import annotations

from random import Random

from cobotwire.sim.peer import Peer

# Packets of the servo bus as they were seen on hosts' lines (the field notes), and NULs.
LEAKS = tuple(
    bytes.fromhex(text)
    for text in (
        "FF FF 01 04 02 38 02 BE",
        "FF FF 01 04 00 FF 07 F4",
        "FF FF FE 0A 82 38 0F 01 02 03 04 05 06 19",
        "FF FF 07 02 01 F5",
        "00 00 00",
    )
)
# One answer in so many has noise in front of it, and as many have it behind.
SELDOM = 20


class NoisyLine:
    """A peer whose answers come whole, but not always alone."""

    def __init__(self, peer: Peer, seed: int) -> None:
        self._peer = peer
        self._random = Random(seed)  # noqa: S311  (noise that can be repeated, not a secret)

    @property
    def wait(self) -> float | None:
        """As the peer's."""
        return self._peer.wait

    def receive(self, data: bytes) -> bytes:
        """As the peer, with noise now and then, even where the peer says nothing."""
        return self._leak() + self._peer.receive(data) + self._leak()

    def flush(self) -> bytes:
        """As the peer."""
        return self._peer.flush()

    def _leak(self) -> bytes:
        return self._random.choice(LEAKS) if self._random.randrange(SELDOM) == 0 else b""
