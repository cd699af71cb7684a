"""Name what can be wrong with a capture; both readers use these texts."""

from __future__ import annotations

from cobotwire.protocol.errors import CaptureError

# Wireshark's own limit; a longer block counts as damage.
LARGEST_BLOCK = 16 * 1024 * 1024
# Each interface needs memory.
MOST_INTERFACES = 1024

_REASONS = {
    "not-pcapng": "the file is not a pcapng recording; cobotwire decode says what it holds",
    "bad-length": f"damaged: a block has length {{}}, not a multiple of 4 in {{}}..{LARGEST_BLOCK}",
    "lengths-differ": "damaged: the two lengths of a block differ",
    "too-short": "damaged: a block is too short for its content",
    "version": "it has pcapng version {}; supported: 1",
    "long-number": "damaged: a number of an interface is too long",
    "link-type": "link type {} is not that of a serial recording",
    "no-interface": "damaged: the file does not describe interface {}",
    "no-time": "its packets have neither a time nor a direction",
    "many-interfaces": f"it describes more than {MOST_INTERFACES} interfaces",
    "interface-lost": "earlier damage makes the number of this interface ambiguous",
    "time-range": "columns cannot hold the time of a packet outside of the years 1678 to 2261",
}


def damaged(name: str, offset: int, kind: str, *numbers: int) -> CaptureError:
    """Return the error for a block at ``offset`` of a file; ``numbers`` are details."""
    return CaptureError(name, offset, _REASONS[kind].format(*numbers))
