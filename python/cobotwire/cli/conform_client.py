"""``cobotwire conform client``: serve an arm that judges every byte a client sends."""

from __future__ import annotations

import shlex
import time
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import click

from cobotwire import editions
from cobotwire.capture.file_errors import unusable_file
from cobotwire.cli.shared.conform_report import (
    ReportFiles,
    conclude,
    exit_if_not_testable,
    report_options,
)
from cobotwire.cli.shared.serving import serve
from cobotwire.conformance.client import FAULTS, Referee, ScriptLine, faulty_replies
from cobotwire.conformance.sources import spec_lines
from cobotwire.inspect.call_arguments import parse, request_values, variant_of
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table
from cobotwire.simulator import PtyServer, Server, TcpServer
from cobotwire.simulator.kinematics import prepare
from cobotwire.simulator.tcp import address


@click.command()
@click.option(
    "--listen", default="pty", show_default=True, help="Where to serve: pty, or socket://HOST:PORT."
)
@click.option(
    "--expect",
    type=click.Path(),
    metavar="FILE",
    help="The calls that the client makes, one per line.",
)
@click.option("--misbehave", default="", help=f"Send bad replies, any of {','.join(FAULTS)}.")
@click.option(
    "--every",
    type=int,
    default=3,
    show_default=True,
    help="With --misbehave: every n-th reply is bad.",
)
@click.option(
    "--delay",
    type=float,
    default=8.0,
    show_default=True,
    help="Milliseconds from each request to its reply.",
)
@click.option(
    "--patience",
    type=float,
    default=30.0,
    show_default=True,
    help="Milliseconds that the client must wait before it repeats a query.",
)
@click.option("--no-acks", is_flag=True, help="Send no acknowledgements, as older firmware does.")
@click.option("--seconds", type=float, help="End after this many seconds.")
@click.option("--idle", type=float, help="End after this many seconds without a request.")
@report_options
@click.pass_obj
def client(
    edition: str,
    listen: str,
    expect: str | None,
    misbehave: str,
    every: int,
    delay: float,
    patience: float,
    no_acks: bool,
    seconds: float | None,
    idle: float | None,
    files: ReportFiles,
) -> None:
    """Serve an arm, and judge the client that controls it.

    The first line of output is the port that the client must open. Over TCP the run ends when the
    client disconnects. On a pseudo-terminal it ends after --idle or --seconds, or at Ctrl-C. With
    --expect the requests are compared with the calls in FILE, which are written as for `cobotwire
    call`:

    \b
      send_angles 0,10,0,0,0,0 speed=30
      get_angles
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    with exit_if_not_testable():
        table = editions.load(edition).TABLE
        for name, value in (("delay", delay), ("patience", patience)):
            if not 0 <= value <= 60_000:
                raise UsageError(name, value, "0..60000 milliseconds")
        faults = [word for word in misbehave.split(",") if word]
        referee = Referee(
            table,
            subject=f"client on {listen}",
            scenario=faulty_replies(delay / 1000, faults, every),
            script=None if expect is None else list(read_script(table, expect)),
            acks=not no_acks,
            patience=patience / 1000,
            sources=spec_lines(edition),
        )
        # An import while the client waits would delay a reply, and a retry would look hasty.
        prepare()
        server = _server(listen, referee)
        serve(server, between=[_Ending(server, referee, seconds, idle).check])
    conclude(referee.finish(), files)


class _Ending:
    """Ends the run when its time is over or the client has disconnected."""

    def __init__(
        self, server: Server, referee: Referee, seconds: float | None, idle: float | None
    ) -> None:
        self._server, self._referee, self._idle = server, referee, idle
        self._end = None if seconds is None else time.monotonic() + seconds
        self._over = False

    def check(self) -> None:
        """Stop the server if the run is over."""
        if not self._over and (self._late() or self._silent() or self._gone()):
            self._over = True
            self._server.stop()

    def _late(self) -> bool:
        return self._end is not None and time.monotonic() >= self._end

    def _silent(self) -> bool:
        silence = self._referee.silence
        return self._idle is not None and silence is not None and silence >= self._idle

    def _gone(self) -> bool:
        if not isinstance(self._server, TcpServer):
            return False
        return self._referee.silence is not None and self._server.clients == 0


def _server(listen: str, referee: Referee) -> Server:
    if listen == "pty":
        return PtyServer(referee)
    parts = urlsplit(listen)
    if parts.scheme not in ("socket", "tcp") or parts.path.strip("/"):
        raise UsageError("listen", listen, "pty or socket://HOST:PORT")
    host, port = address(parts.netloc)
    # All connections count as the same client, because the referee judges one client.
    server = TcpServer(lambda: referee, host, port)
    if not server.loopback:
        text = f"anyone who can reach {host} can connect, and is judged as the client"
        click.echo(f"cobotwire: {text}", err=True)
    return server


def read_script(table: Table, path: str) -> Iterator[ScriptLine]:
    """Yield the calls in a file.

    Raises:
        UsageError: the file cannot be read, or a line is not a call.
    """
    try:
        lines = Path(path).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeError) as error:
        raise unusable_file("expect", path, error) from error
    for number, line in enumerate(lines, 1):
        place = f"{path}:{number}"
        try:
            if words := shlex.split(line, comments=True):
                yield _script_line(table, words, place)
        # shlex raises a ValueError, and so does a wrong call: UsageError is one.
        except ValueError as error:
            raise UsageError("expect", line, message=f"{place}: {error}") from None


def _script_line(table: Table, words: list[str], place: str) -> ScriptLine:
    """Parse a call; the text that follows some requests is not compared."""
    command = table.command(words[0])
    given = parse(command, words[1:])
    return ScriptLine(command, request_values(command, given), place, variant_of(command, given))
