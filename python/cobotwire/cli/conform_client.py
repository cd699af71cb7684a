"""``cobotwire conform client``: an arm that judges every byte which a client sends."""

from __future__ import annotations

import shlex
import time
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import click

from cobotwire import editions
from cobotwire.cli.arguments import framed, parse
from cobotwire.cli.conforming import ReportFiles, conclude, could_not_run, report_options
from cobotwire.cli.serving import serve
from cobotwire.conformance.client import MISDEEDS, Manners, Referee, Told
from cobotwire.conformance.places import places_of
from cobotwire.errors import UsageError
from cobotwire.sim import PtyPort, Server, TcpPort
from cobotwire.sim.kinematics import prepare
from cobotwire.sim.tcp import address
from cobotwire.table import Table


@click.command()
@click.option("--listen", default="pty", help="pty, or socket://127.0.0.1:PORT; port 0 is any.")
@click.option("--expect", metavar="FILE", help="What the client was told to send: a call a line.")
@click.option("--misbehave", default="", help=f"Answer badly now and then: {','.join(MISDEEDS)}.")
@click.option("--every", type=int, default=3, help="Every so many answers a bad one [3].")
@click.option("--delay", type=float, default=8.0, help="Milliseconds until an answer [8].")
@click.option("--patience", type=float, default=30.0, help="Milliseconds a reply may take [30].")
@click.option("--no-acks", is_flag=True, help="Acknowledge no orders, as older firmware.")
@click.option("--seconds", type=float, help="End after so long.")
@click.option("--idle", type=float, help="End when the client was silent for so many seconds.")
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
    """Serve an arm, and judge the client that drives it.

    The first line is what the client has to open. Over TCP the run ends when the client has gone,
    on a pseudo-terminal by --idle, --seconds or Ctrl-C. With --expect values are compared with
    what the client was told; a line is a call as for `cobotwire call`:

    \b
      send_angles 0,10,0,0,0,0 speed=30
      get_angles
    """  # noqa: D301  (\b is the control character by which click keeps the lines)
    with could_not_run():
        table = editions.load(edition).TABLE
        for name, value in (("delay", delay), ("patience", patience)):
            if not 0 <= value <= 60_000:
                raise UsageError(name, value, "0..60000 milliseconds")
        misdeeds = [word for word in misbehave.split(",") if word]
        referee = Referee(
            table,
            subject=f"client on {listen}",
            manners=Manners(delay / 1000, misdeeds, every),
            script=None if expect is None else list(read_script(table, expect)),
            acks=not no_acks,
            patience=patience / 1000,
            places=places_of(edition),
        )
        # A referee that imports while the client waits would take its second try for haste.
        prepare()
        server = _server(listen, referee)
        serve(server, looks=[_Ending(server, referee, seconds, idle).look])
    conclude(referee.finish(), files)


class _Ending:
    """Looks now and then whether the run is over."""

    def __init__(
        self, server: Server, referee: Referee, seconds: float | None, idle: float | None
    ) -> None:
        self._server, self._referee, self._idle = server, referee, idle
        self._end = None if seconds is None else time.monotonic() + seconds
        self._over = False

    def look(self) -> None:
        """Stop the server once, when the time is over or the client has gone."""
        if not self._over and (self._late() or self._silent() or self._gone()):
            self._over = True
            self._server.stop()

    def _late(self) -> bool:
        return self._end is not None and time.monotonic() >= self._end

    def _silent(self) -> bool:
        silence = self._referee.silence
        return self._idle is not None and silence is not None and silence >= self._idle

    def _gone(self) -> bool:
        if not isinstance(self._server, TcpPort):
            return False
        return self._referee.silence is not None and self._server.clients == 0


def _server(listen: str, referee: Referee) -> Server:
    if listen == "pty":
        return PtyPort(referee)
    parts = urlsplit(listen)
    if parts.scheme not in ("socket", "tcp") or parts.path.strip("/"):
        raise UsageError("listen", listen, "pty, or socket://127.0.0.1:PORT")
    host, port = address(parts.netloc)
    # Whoever comes is taken for the same client: judging is about one.
    return TcpPort(lambda: referee, host, port)


def read_script(table: Table, path: str) -> Iterator[Told]:
    """The calls of a script.

    Raises:
        UsageError: the file cannot be read, or a line is no call; the text says where.
    """
    try:
        lines = Path(path).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeError) as error:
        raise UsageError("expect", path, f"a text file ({error})") from error
    for number, line in enumerate(lines, 1):
        words = shlex.split(line, comments=True)
        if words:
            place = f"{path}:{number}"
            try:
                yield _told(table, words, place)
            except UsageError as error:
                raise UsageError(f"{place}: {error.argument}", error.value, error.allowed) from None


def _told(table: Table, words: list[str], place: str) -> Told:
    """A call as it is written; the text behind a request is not compared."""
    command = table.command(words[0])
    return Told(command, framed(command, parse(command, words[1:])), place)
