"""Start the client under test, and notice when it ends."""

from __future__ import annotations

import shlex
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from cobotwire.conformance import programs
from cobotwire.protocol.errors import UsageError

PORT_WORD = "{port}"


@contextmanager
def started_client(command: str | None, port: str) -> Iterator[Callable[[], str | None]]:
    """Run a client while the block runs; do nothing if ``command`` is None.

    Args:
        command: the program and its arguments; ``{port}`` stands for the port.
        port: what the client has to open.

    Yields a function that returns how the client ended: None while it runs, empty if it ended well.

    Raises:
        UsageError: ``command`` names no program, or lacks ``{port}``.
        LinkError: the client cannot be started.
    """
    if command is None:
        yield lambda: None
        return
    try:
        words = [word.replace(PORT_WORD, port) for word in shlex.split(command)]
    except ValueError as error:
        raise UsageError("command", command, message=f"--command {command!r}: {error}") from None
    if not words or PORT_WORD not in command:
        message = f"--command needs a program, and {PORT_WORD} where it takes the port to open"
        raise UsageError("command", command, message=message)
    with tempfile.TemporaryFile() as diagnostics:
        # The client's output would mix with ours, which begins with a line that names the port.
        process = programs.start(
            words, words[0], subprocess.DEVNULL, subprocess.DEVNULL, diagnostics
        )

        def ended() -> str | None:
            code = process.poll()
            if code is None:
                return None
            return f"the client: {programs.ending(code, diagnostics)}" if code else ""

        try:
            yield ended
        finally:
            programs.end(process)
