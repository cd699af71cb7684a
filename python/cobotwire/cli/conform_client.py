"""``cobotwire conform client``: serve an arm that checks every byte a client sends."""

from __future__ import annotations

import shlex
import time
from collections.abc import Callable, Iterator
from urllib.parse import urlsplit

import click

from cobotwire import editions
from cobotwire.cli.shared.arm_options import parse_address
from cobotwire.cli.shared.conform_report import (
    ReportOptions,
    conclude,
    exit_if_not_testable,
    report_options,
    text_of_file,
)
from cobotwire.cli.shared.earlier_reports import earlier_report
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.serving import serve
from cobotwire.cli.shared.started_client import started_client
from cobotwire.conformance.client import FAULTS, ClientOptions, Referee, ScriptLine
from cobotwire.conformance.provenance import identify
from cobotwire.conformance.sources import spec_lines
from cobotwire.inspect.call_arguments import parse, request_values, variant_of
from cobotwire.protocol.addresses import find_address
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table
from cobotwire.simulator import PtyServer, Server, TcpServer
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
@click.option(
    "--command",
    metavar="COMMAND",
    help="Start this client ({port} stands for the port), and end when it ends.",
)
@click.option(
    "--again",
    type=click.Path(),
    metavar="REPORT",
    help="Repeat the run of a JSON report, with its options and script.",
)
@report_options
@uses_edition
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
    command: str | None,
    again: str | None,
    wanted: ReportOptions,
) -> None:
    """Serve an arm, and check the client that controls it.

    The first line of output is the port that the client must open. Over TCP the run ends when the
    client disconnects. On a pseudo-terminal it ends after --idle or --seconds, or at Ctrl-C. With
    --expect the requests are compared with the calls in FILE, which are written as for `cobotwire
    call`:

    \b
      send_angles 0,10,0,0,0,0 speed=30
      get_angles

    In an edition with addresses, a call may end with --address and a name or a number.
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    with exit_if_not_testable():
        table = editions.load(edition).TABLE
        text = "" if expect is None else text_of_file("expect", expect)
        options = ClientOptions(
            misbehave,
            every,
            delay,
            patience,
            no_acks,
            text,
            expect or "",
            expected=wanted.expected,
            expected_name=wanted.expected_name,
        )
        earlier = earlier_report(None, again, options.for_report(), edition, "client")
        if earlier is not None:
            options = ClientOptions.of_report(earlier.options)
        known = options.known_failures()
        referee = Referee(
            table,
            subject=f"client on {listen}" if command is None else f"command {command}",
            scenario=options.scenario(),
            script=_script(table, options),
            acks=not options.no_acks,
            patience=options.patience / 1000,
            sources=spec_lines(edition),
        )
        referee.report.options = options.for_report()
        server = _server(listen, referee)
        identify(referee.report, edition, port=server.url)
        with started_client(command, server.url) as ended:
            ending = _Ending(server, referee, seconds, idle, ended)
            serve(server, between=[ending.check])
            referee.report.stopped = ending.why
    conclude(referee.finish(), wanted, known)


class _Ending:
    """Ends the run on a time limit, after silence, or when the client has gone."""

    def __init__(
        self,
        server: Server,
        referee: Referee,
        seconds: float | None,
        idle: float | None,
        ended: Callable[[], str | None],
    ) -> None:
        self._server, self._referee, self._idle = server, referee, idle
        self._ended = ended
        # Why the run ends early; empty if it does not.
        self.why = ""
        self._end = None if seconds is None else time.monotonic() + seconds
        self._over = False

    def check(self) -> None:
        """Stop the server if the run is over."""
        ended = self._ended()
        over = ended is not None or self._late() or self._silent() or self._gone()
        if over and not self._over:
            self._over, self.why = True, ended or ""
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
    # A run checks one client, so all connections count as that client.
    server = TcpServer(lambda: referee, host, port)
    if not server.loopback:
        text = f"anyone who can reach {host} can connect, and is checked as the client"
        click.echo(f"cobotwire: {text}", err=True)
    return server


def _script(table: Table, options: ClientOptions) -> list[ScriptLine] | None:
    """Return the calls that the client makes; None if they are not known."""
    if not options.script_name:
        return None
    return list(read_script(table, options.script, options.script_name))


def read_script(table: Table, text: str, name: str) -> Iterator[ScriptLine]:
    """Yield the calls in the text of a file.

    Raises:
        UsageError: a line is not a call.
    """
    for number, line in enumerate(text.splitlines(), 1):
        place = f"{name}:{number}"
        try:
            if words := shlex.split(line, comments=True):
                yield _script_line(table, words, place)
        # shlex raises ValueError. A wrong call raises UsageError, a subclass of ValueError.
        except ValueError as error:
            raise UsageError("expect", line, message=f"{place}: {error}") from None


def _script_line(table: Table, words: list[str], place: str) -> ScriptLine:
    """Parse a call of the script. The text that follows some requests is not part of a call."""
    address = None
    if words[1:][-2:-1] == ["--address"]:
        *words, _, to = words
        address = find_address(table, parse_address(to))
    command = table.command(words[0])
    given = parse(command, words[1:])
    values, variant = request_values(command, given), variant_of(command, given)
    return ScriptLine(command, values, place, variant, address and address.value)
