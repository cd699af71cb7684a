"""Run the session with pymycobot, unmodified, and with our two clients."""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Callable
from functools import partial

from field_notes.play import AS_LIBRARY, OPENERS
from referee.calls import SESSION

# Opens a URL, makes all calls and closes it; returns the failed calls, each with its error.
Play = Callable[[str], list[str]]


def play(library: str, url: str) -> list[str]:
    """Run the session with a library."""
    failures = []
    with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
        # The import of pymycobot uses deprecated features, and it prints while it decodes.
        warnings.simplefilter("ignore")
        arm = OPENERS[library](url)
        for call in SESSION:
            try:
                result = getattr(arm, call.name)(*call.arguments)
            except Exception as error:  # any exception is listed, and the session continues
                failures.append(f"{call.name}: {type(error).__name__}: {error}")
            else:
                if library in AS_LIBRARY and result in (None, -1):
                    failures.append(f"{call.name}: {result!r}")
        if library in AS_LIBRARY:
            arm.close()
        else:
            arm.__exit__(None, None, None)
    return failures


CLIENTS: dict[str, tuple[str, Play]] = {
    "pymycobot": ("pty", partial(play, "pymycobot")),
    "pymycobot socket": ("tcp", partial(play, "pymycobot")),
    "cobotwire": ("pty", partial(play, "blocking")),
    "cobotwire tcp": ("tcp", partial(play, "blocking")),
    "cobotwire asyncio": ("pty", partial(play, "asyncio")),
    "cobotwire asyncio tcp": ("tcp", partial(play, "asyncio")),
}
