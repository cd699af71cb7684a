"""Start the client under test, and notice when it ends."""

from __future__ import annotations

import shlex
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from cobotwire.conformance.last_words import ending
from cobotwire.protocol.errors import LinkError, UsageError

PORT_WORD = "{port}"
# How long a client may take to end after it was asked to, in seconds.
ENDING = 2.0


@contextmanager
def started_client(command: str | None, port: str) -> Iterator[Callable[[], str | None]]:
    """Run a client while the block runs; None: it is started by others.

    Args:
        command: the program and its arguments; ``{port}`` stands for the port.
        port: what the client has to open.

    Yields a function that returns how the client ended: None while it runs, empty if it ended well.

    Raises:
        UsageError: the command is not one.
        LinkError: it cannot be started.
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
        try:
            # Its output would mix with ours, of which the first line is the port.
            process = subprocess.Popen(  # noqa: S603  (running the caller's command is the point)
                words,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=diagnostics,
                start_new_session=True,
            )
        except OSError as error:
            raise LinkError(words[0], f"cannot be started: {error.strerror or error}") from error

        def ended() -> str | None:
            code = process.poll()
            if code is None:
                return None
            return f"the client: {ending(code, diagnostics)}" if code else ""

        try:
            yield ended
        finally:
            _stop(process)


def _stop(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(ENDING)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
