"""Find the edition that a recording names. Another one would decode its frames to wrong values."""

from __future__ import annotations

from functools import lru_cache

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.printable import printable


@lru_cache
def codec_of_recording(recorded: str, default: str) -> Codec:
    """Return the codec for a recording.

    Args:
        recorded: the edition that the recording names; empty if it names none.
        default: the edition of a recording that names none. If it is a package of your own, also
            the edition of recordings that name it.

    Raises:
        UsageError: the recording names an edition that is neither installed nor the default one.
    """
    # The name in a recording is data from outside: it is compared, and never imported.
    if recorded in editions.names():
        return codecs.load(editions.load(recorded).TABLE)
    table = editions.load(default).TABLE
    if recorded not in ("", table.edition):
        name = printable(recorded)
        message = (
            f"the recording names the edition {name!r}, which is not installed; if you have its "
            f"package, choose it by its name or folder: cobotwire --edition PACKAGE, or the "
            f"argument edition"
        )
        raise UsageError("edition", recorded, message=message)
    return codecs.load(table)
