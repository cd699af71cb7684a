"""Run a session of pymycobot 4.0.7 and of our clients with the client tester; print failures.

.venv/bin/python bench/client_findings.py                 # all clients, all lines
.venv/bin/python bench/client_findings.py --only cobotwire
"""

from __future__ import annotations

import argparse
import contextlib
import io
import time
import warnings
from typing import NamedTuple

from cobotwire.conformance import Report
from cobotwire.conformance.client import Referee, faulty_replies
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import PtyServer, Server, TcpServer
from field_notes.play import AS_LIBRARY, OPENERS
from referee.calls import SESSION, script

# By name: the library, and whether it opens a pty or a TCP connection.
CLIENTS = {
    "pymycobot": ("pymycobot", PtyServer),
    "pymycobot socket": ("pymycobot", TcpServer),
    "cobotwire": ("blocking", PtyServer),
    "cobotwire tcp": ("blocking", TcpServer),
    "cobotwire asyncio": ("asyncio", PtyServer),
    "cobotwire asyncio tcp": ("asyncio", TcpServer),
    "cobotwire rust": ("rust", PtyServer),
    "cobotwire rust tcp": ("rust", TcpServer),
    "cobotwire rust async": ("rust async", PtyServer),
    "cobotwire rust async tcp": ("rust async", TcpServer),
    "cobotwire node tcp": ("node", TcpServer),
}


class Line(NamedTuple):
    """How the arm replies."""

    text: str
    faults: tuple[str, ...] = ()
    acks: bool = True
    delay: float = 0.008


LINES: dict[str, Line] = {
    "good": Line("every reply after 8 ms"),
    "no-acks": Line("older firmware: changes are not acknowledged", acks=False),
    "lost": Line("every fifth reply is lost", ("lost",)),
    "late": Line("every fifth reply comes 0.6 s late", ("late",)),
    "split": Line("every fifth reply in two parts, 50 ms apart", ("split",)),
    "merged": Line("every fifth reply comes with the next one", ("merged",)),
    "noise": Line("a servo packet before every fifth reply", ("noise",)),
}


def play(library: str, url: str) -> list[str]:
    """Run the session with a library; return the calls that raised or returned an error."""
    failures = []
    with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
        # The import of pymycobot uses deprecated features, and it prints while it decodes.
        warnings.simplefilter("ignore")
        arm = OPENERS[library](url)
        for call in SESSION:
            # The probe calls by name, with the values of the request: degrees, where methods take
            # radians.
            by_name = library.startswith(("rust", "node")) and call.fields
            try:
                result = getattr(arm, call.name)(*(by_name or call.arguments))
            except Exception as error:  # list any exception, and continue the session
                failures.append(f"{call.name}: {type(error).__name__}: {error}")
            else:
                if library in AS_LIBRARY and result in (None, -1):
                    failures.append(f"{call.name}: {result!r}")
        if library in AS_LIBRARY:
            arm.close()
        else:
            arm.__exit__(None, None, None)
    return failures


def checked(client: str, line: Line) -> tuple[Report, list[str]]:
    """Run the session; return the report, and the calls that raised or returned an error."""
    library, kind = CLIENTS[client]
    referee = Referee(
        TABLE,
        subject=client,
        scenario=faulty_replies(line.delay, line.faults, every=5),
        script=script(),
        acks=line.acks,
    )
    server: Server = PtyServer(referee) if kind is PtyServer else TcpServer(lambda: referee)
    with server:
        failures = play(library, server.url)
        _settle(referee)
    return referee.finish(), failures


def _settle(referee: Referee) -> None:
    """Let the last requests arrive: a client may close its port right after sending them."""
    while (referee.silence or 0.0) < 0.3:
        time.sleep(0.05)


def main() -> None:
    """Print the failures of each client on each line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="only clients with names that begin like this")
    parser.add_argument("--line", choices=LINES, help="only this line")
    options = parser.parse_args()
    for client in CLIENTS:
        for name, line in LINES.items():
            if client.startswith(options.only) and options.line in (None, name):
                _print(client, name, line)


def _print(client: str, name: str, line: Line) -> None:
    report, failures = checked(client, line)
    found = report.failures
    print(f"{client}, {name} ({line.text}): {len(found)} failures, {len(failures)} calls failed")
    for result in found:
        print(f"    {result.case:20} {result.command:22} {result.reason}")
    for failure in failures:
        print(f"    call failed          {failure[:110]}")


if __name__ == "__main__":
    main()
