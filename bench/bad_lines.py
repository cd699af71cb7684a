"""Run the cases of the field notes with four clients; write docs/bad-lines.md.

    make table

Each case runs on a real pty and over real TCP, with one client at a time: our blocking one, our
asyncio one, our layer with the maker's names, and unmodified pymycobot 4.0.7. Each client runs in a
separate process. A client that exceeds the time limit is ended, and counts as hanging.
"""

from __future__ import annotations

import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import apart
from bad_lines_page import BEGIN, END, Row, page
from field_notes.case import Case
from field_notes.cases import CASES
from field_notes.line import line_of
from field_notes.play import Outcome, play

DOCUMENT = Path(__file__).parents[1] / "docs" / "bad-lines.md"
CLIENTS = ("blocking", "asyncio", "layer", "pymycobot")
AT_ONCE = 4
LIMIT_SECONDS = 12.0
PRELOADED = ["field_notes.play", "field_notes.cases", "cobotwire.pymycobot.mycobot280", "pymycobot"]


class Run(NamedTuple):
    """One case, on one kind of line, with one client."""

    case: Case
    transport: str
    who: str


def main() -> None:
    """Run the named cases and print their rows; without names, run all and write the page."""
    chosen = [CASES[name] for name in sys.argv[1:]] or list(CASES.values())
    runs = [
        Run(case, transport, who)
        for case in chosen
        for transport in case.transports
        for who in CLIENTS
    ]
    apart.warm_up(PRELOADED)
    with ThreadPoolExecutor(AT_ONCE) as pool:
        rows = list(pool.map(_measured, runs))
    results = {(run.case.name, run.transport, run.who): row for run, row in zip(runs, rows)}
    if sys.argv[1:]:
        for key, row in results.items():
            print(*key, row.text(LIMIT_SECONDS), sep=" | ")
    else:
        text = page(results, CLIENTS, LIMIT_SECONDS)
        before, _, rest = DOCUMENT.read_text().partition(BEGIN)
        DOCUMENT.write_text(before + text + rest.partition(END)[2].lstrip("\n"))
        print(f"{len(rows)} runs, written to {DOCUMENT}")


def _measured(run: Run) -> Row:
    with line_of(run.case, run.transport) as line:
        clients = range(run.case.clients)
        started = [apart.start(_play, run.case.name, run.who, line.url, at) for at in clients]
        until = time.monotonic() + LIMIT_SECONDS
        results = [one.result(until) for one in started]
        line.settle()
        frames, garbled = line.frames, line.garbled
    ended = [result for result in results if result is not None]
    outcomes = [outcome for result in ended for outcome in result[0]]
    seconds = max((result[1] for result in ended), default=LIMIT_SECONDS)
    return Row(run.case, outcomes, seconds, frames, garbled, hung=len(ended) < len(results))


def _play(name: str, who: str, url: str, client: int) -> tuple[list[Outcome], float]:
    return play(CASES[name], who, url, client)


if __name__ == "__main__":
    main()
