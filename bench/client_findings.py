"""A whole session of pymycobot 4.0.7 and of our clients before the referee; prints its findings.

.venv/bin/python bench/client_findings.py                 # all clients, all lines
.venv/bin/python bench/client_findings.py --only cobotwire
"""

from __future__ import annotations

import argparse
import time
from typing import NamedTuple

from cobotwire.conformance import Report, Verdict
from cobotwire.conformance.client import Manners, Referee
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.sim import PtyPort, Server, TcpPort
from cobotwire.sim.kinematics import prepare
from referee.calls import script
from referee.clients import CLIENTS


class Line(NamedTuple):
    """How the arm answers."""

    text: str
    misdeeds: tuple[str, ...] = ()
    acks: bool = True
    delay: float = 0.008


LINES: dict[str, Line] = {
    "good": Line("every answer after 8 ms"),
    "no-acks": Line("older firmware: orders are not acknowledged", acks=False),
    "lost": Line("every fifth answer is lost", ("lost",)),
    "late": Line("every fifth answer comes 0.6 s late", ("late",)),
    "split": Line("every fifth answer in two parts, 50 ms apart", ("split",)),
    "merged": Line("every fifth answer comes with the next one", ("merged",)),
    "noise": Line("a servo packet in front of every fifth answer", ("noise",)),
}


def judged(client: str, line: Line) -> tuple[Report, list[str]]:
    """Play the session; gives the report, and which calls failed for the caller."""
    prepare()
    kind, play = CLIENTS[client]
    referee = Referee(
        TABLE,
        subject=client,
        manners=Manners(line.delay, line.misdeeds, every=5),
        script=script(),
        acks=line.acks,
    )
    server: Server = PtyPort(referee) if kind == "pty" else TcpPort(lambda: referee)
    with server:
        failures = play(server.url)
        _settle(referee)
    return referee.finish(), failures


def _settle(referee: Referee) -> None:
    """Let the last orders arrive: who closes a port has not waited for them."""
    while (referee.silence or 0.0) < 0.3:
        time.sleep(0.05)


def main() -> None:
    """Print a table and the findings behind it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="clients whose name begins so")
    parser.add_argument("--line", choices=LINES, help="one line alone")
    options = parser.parse_args()
    for client in CLIENTS:
        for name, line in LINES.items():
            if client.startswith(options.only) and options.line in (None, name):
                _print(client, name, line)


def _print(client: str, name: str, line: Line) -> None:
    report, failures = judged(client, line)
    found = [result for result in report.results if result.verdict is Verdict.FAIL]
    print(f"{client}, {name} ({line.text}): {len(found)} findings, {len(failures)} calls failed")
    for result in found:
        print(f"    {result.rule:20} {result.command:22} {result.reason}")
    for failure in failures:
        print(f"    call failed          {failure[:110]}")


if __name__ == "__main__":
    main()
