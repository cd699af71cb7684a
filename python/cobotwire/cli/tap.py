"""``cobotwire tap``: watch what passes between a program and its arm."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from contextlib import closing
from functools import partial
from typing import Any

import click

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.capture import Packet, Recording
from cobotwire.cli.shared.arm_options import arm_options
from cobotwire.cli.shared.completers import complete_commands, complete_ports
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.exit_codes import exit_on_errors
from cobotwire.cli.shared.line_output import LineOutput
from cobotwire.cli.shared.output import as_hex, fold, report_written
from cobotwire.cli.shared.packet_lines import meaning_of, packet_as_json, packet_line
from cobotwire.cli.shared.serving import serve
from cobotwire.cli.shared.simulator_output import JsonLines, Lines
from cobotwire.codec.interface import Codec
from cobotwire.inspect.following import SCHEME
from cobotwire.inspect.tap.copies import Copies, Copy
from cobotwire.inspect.tap.forwarder import Forwarder, check_pollable
from cobotwire.inspect.tap.guard import Guard
from cobotwire.inspect.tap.process import WatchingProcess
from cobotwire.inspect.tap.program_ends import ProgramEnd, PtyEnd, TcpEnd
from cobotwire.inspect.tap.watching import Watching
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Table
from cobotwire.simulator.tcp import address
from cobotwire.transport import open_transport


@click.command()
@click.argument("port", metavar="URL", shell_complete=complete_ports)
@arm_options
@click.option(
    "--tcp",
    metavar="[HOST]:PORT",
    help="Offer a TCP port instead of a pseudo-terminal; :0 is a free one.",
)
@click.option("--read-only", is_flag=True, help="Let only queries and stop commands pass.")
@click.option(
    "--only",
    multiple=True,
    metavar="NAME",
    shell_complete=complete_commands,
    help="Print only this command, or this class: query, motion, noise, ...; repeatable.",
)
@click.option("--quiet", is_flag=True, help="Print no traffic.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object per line.")
@uses_edition
def tap(
    edition: str,
    port: str,
    baudrate: int | None,
    record: str | None,
    tcp: str | None,
    read_only: bool,
    only: tuple[str, ...],
    quiet: bool,
    as_json: bool,
) -> None:
    """Forward everything between a program and the arm at URL, and show it, until Ctrl-C.

    The first line of output is the port for the program: a pseudo-terminal, or with --tcp a URL.
    Then comes a line for each frame and for noise. Every byte passes unchanged, none is added, and
    neither the program nor the arm waits for the output. While it records, cobotwire studio and
    monitor can watch: give them follow:FILE as URL.

    With --read-only, only whole requests that are queries, or that stop the arm, reach the arm.
    All other bytes are held back, and printed.
    """
    if sys.platform == "win32":
        raise UsageError("tap", port, message="tap needs Linux or macOS")
    table = editions.load(edition).TABLE
    _check_only(table, only)
    codec = codecs.load(table)
    tcp_address = None if tcp is None else address(tcp)
    speed = table.baudrate if baudrate is None else baudrate
    with closing(open_transport(port, speed)) as arm:
        check_pollable(arm)
        program = PtyEnd() if tcp_address is None else TcpEnd(*tcp_address)
        recording = None
        if record is not None:
            recording = partial(Recording, record, codec, url=port, baudrate=speed)
        show = _Show(codec, port, set(only), as_json, quiet)
        process = WatchingProcess(partial(_watch, program, codec, recording, show))
        try:
            guard = Guard(codec) if read_only else None
            forwarder = Forwarder(arm, program, Copies(process.copies), guard)
            if process.watches:
                serve(forwarder, show.serving(program.url, record))
            else:
                forwarder.close()
        finally:
            code = process.end()
            if record is not None and code == 0:
                report_written(record)
    sys.exit(code)


def _watch(
    program: ProgramEnd,
    codec: Codec,
    open_recording: Callable[[], Recording] | None,
    show: _Show,
    copies: int,
    begin: Callable[[], None],
) -> None:
    """Watch in the watching process; report errors as every subcommand does."""
    # A pty hangs up only when no process has it open.
    program.close()
    with exit_on_errors(), closing(show.lines):
        recording = None if open_recording is None else open_recording()
        begin()
        watching = Watching(copies, codec, recording, show.packet, show.other)
        watching.run(show.lines.flush)


def _check_only(table: Table, only: tuple[str, ...]) -> None:
    commands = {command.name for command in table.commands}
    classes = {command.safety for command in table.commands} | {"noise"}
    for name in {*only} - commands - classes:
        allowed = f"a command of {table.edition}, or {', '.join(sorted(classes))}"
        raise UsageError("only", name, allowed)


class _Show:
    """Prints what passes, as ``cobotwire replay`` prints a recording."""

    def __init__(
        self,
        codec: Codec,
        url: str,
        only: set[str],
        as_json: bool,
        quiet: bool,
    ) -> None:
        self._codec, self._url, self._only = codec, url, only
        self._as_json, self._quiet, self._ended = as_json, quiet, False
        self.lines = LineOutput((JsonLines() if as_json else Lines()).left_out)
        self._start_ns, self._started_at = time.time_ns(), time.monotonic()

    def serving(self, url: str, record: str | None) -> str:
        """Return the first lines."""
        if self._as_json:
            return json.dumps({"event": "serving", "url": url})
        hint = f"\nnote       to watch it, run: cobotwire studio {SCHEME}{record}"
        return url if record is None else url + hint

    def packet(self, packet: Packet) -> None:
        if self._quiet or not self._is_chosen(packet):
            return
        after, meaning = (packet.time_ns - self._start_ns) / 1e9, meaning_of(packet, self._codec)
        if self._as_json:
            passed = packet_as_json(packet, self._url, after, meaning)
            self._print(json.dumps({"event": "passed", **passed}))
        else:
            self._print(packet_line(packet, after, meaning))

    def other(self, copy: Copy) -> None:
        """Show what is not traffic of the arm: requests that were held back, and notes."""
        after, text = copy.time - self._started_at, copy.data.decode("latin-1")
        if copy.kind == "held":
            meaning = meaning_of(Packet(0, "sent", copy.data), self._codec)
            data = as_hex(copy.data)
            self._event("held back", f"{data}   {meaning}", after=after, data=data, meaning=meaning)
        elif copy.kind == "dropped":
            text = f"{text} bytes passed that are neither shown nor recorded"
            self._event("dropped", text, bytes=int(copy.data))
        else:
            self._event("note", text, text=text)

    def _event(self, event: str, line: str, **content: Any) -> None:
        made = json.dumps({"event": event, **content})
        self._print(made if self._as_json else fold(f"{event:<10} {line}"))

    def _print(self, line: str) -> None:
        try:
            if not self._ended:
                self.lines.print(line)
        except OSError as error:
            # The recording continues: perhaps only the disk that holds the output is full.
            self._ended = True
            click.echo(f"cobotwire: the output ends here: {error}", err=True)

    def _is_chosen(self, packet: Packet) -> bool:
        if not self._only:
            return True
        if packet.kind == "noise":
            return "noise" in self._only
        try:
            sent = packet.direction == "sent"
            command = self._codec.decode("request" if sent else "reply", packet.data).command
        except ProtocolError:
            return False
        return bool({command.name, command.safety} & self._only)
