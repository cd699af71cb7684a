"""Run the fault scenarios with our client and pymycobot; write docs/fault-scenarios.md.

    make faults

Each scenario of the package is applied to an arm that always sends the same replies, on a real pty.
Each client makes the same 18 calls in a separate process, which is ended after a time limit. With
names on the command line, the bench prints their rows and writes nothing.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import apart
from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.session.device import DeviceEvent
from cobotwire.simulator import PtyServer
from cobotwire.simulator.faults import find, shipped
from fault_session import CAREFUL, SESSION, TimedOutcome, play_session
from field_notes.case import DONE, Call
from field_notes.line import frames_of, steady_arm
from field_notes.play import RIGHT, WRONG, Outcome

DOCUMENT = Path(__file__).parents[1] / "docs" / "fault-scenarios.md"
BEGIN, END = "<!-- begin: make faults -->", "<!-- end: make faults -->"
CLIENTS = {
    "blocking": "cobotwire",
    CAREFUL: "cobotwire, `ack_within=0.5`",
    "pymycobot": "pymycobot 4.0.7",
}
AT_ONCE = 4
LIMIT_SECONDS = 60.0
KINDS = ("right", "honest error", "-1 or None", WRONG, "exception", "not ended")
# Seconds; shorter means are not shown.
NOTICEABLE = 0.01
# A run without a scenario, for comparison.
NONE = "(none)"


class Run(NamedTuple):
    """The outcome of one scenario with one client.

    Attributes:
        kinds: how many calls ended in each way.
        seconds: the duration of each call that ended.
        again: how many one-way requests arrived more often than their methods were called.
    """

    kinds: Counter[str]
    seconds: list[float]
    again: int


def main() -> None:
    """Run the named scenarios; without names, run all and write the page."""
    names = sys.argv[1:] or [NONE, *shipped()]
    apart.warm_up(["fault_session", "pymycobot"])
    wanted = [(name, who) for name in names for who in CLIENTS]
    started = time.monotonic()
    with ThreadPoolExecutor(AT_ONCE) as pool:
        runs = dict(zip(wanted, pool.map(lambda one: _measured(*one), wanted)))
    text = _page(names, runs)
    if sys.argv[1:]:
        print(text)
        return
    before, _, rest = DOCUMENT.read_text().partition(BEGIN)
    DOCUMENT.write_text(f"{before}{BEGIN}\n\n{text}\n\n{END}{rest.partition(END)[2]}")
    print(f"{len(runs)} runs in {time.monotonic() - started:.0f} s, written to {DOCUMENT}")


def _measured(name: str, who: str) -> Run:
    received: list[DeviceEvent] = []
    arm = steady_arm(received)
    codec = codecs.load(TABLE)
    peer = arm if name == NONE else find(name, TABLE).wrap(arm, codec)
    with PtyServer(peer) as port:
        started = apart.start(play_session, who, port.url)
        timed = started.result(time.monotonic() + LIMIT_SECONDS)
        # Wait for the last bytes that the client wrote.
        time.sleep(0.3)
    return _counted(timed, frames_of(received))


def _counted(timed: list[TimedOutcome] | None, frames: list[bytes]) -> Run:
    if timed is None:
        return Run(Counter({"not ended": len(SESSION)}), [], 0)
    kinds = Counter(_kind(call, one.outcome, frames) for call, one in zip(SESSION, timed))
    sent = [call.sends for call in SESSION if call.right == DONE]
    again = sum(frames.count(one) > sent.count(one) for one in sent)
    return Run(kinds, [one.seconds for one in timed], again)


def _kind(call: Call, outcome: Outcome, frames: list[bytes]) -> str:
    """Return how a call ended; success is wrong if its one-way request did not arrive."""
    if outcome.verdict == RIGHT and call.right == DONE:
        if outcome.detail == "-1":
            return "-1 or None"
        return RIGHT if call.sends in frames else WRONG
    if outcome.verdict in (RIGHT, WRONG):
        return outcome.verdict
    if outcome.verdict in ("-1", "None"):
        return "-1 or None"
    return "honest error" if outcome.meant else "exception"


def _page(names: list[str], runs: dict[tuple[str, str], Run]) -> str:
    head = ["scenario", "what goes wrong", *CLIENTS.values()]
    lines = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    for name in names:
        about = "Nothing." if name == NONE else find(name, TABLE).about
        cells = [_cell(runs[name, who]) for who in CLIENTS]
        lines.append(f"| {name} | {about} | {' | '.join(cells)} |")
    return _sums(runs) + "\n\n" + "\n".join(lines)


def _sums(runs: dict[tuple[str, str], Run]) -> str:
    lines = [f"| calls that ended | {' | '.join(CLIENTS.values())} |", "|---|---|---|---|"]
    for kind in KINDS:
        sums = [
            sum(run.kinds[kind] for (_, by), run in runs.items() if by == who) for who in CLIENTS
        ]
        lines.append(f"| {kind} | {' | '.join(map(str, sums))} |")
    again = [sum(run.again for (_, by), run in runs.items() if by == who) for who in CLIENTS]
    lines.append(
        f"| (one-way requests that arrived twice or more) | {' | '.join(map(str, again))} |"
    )
    return "\n".join(lines)


def _cell(run: Run) -> str:
    """Return a cell such as ``all right`` or ``16 right, 2 -1 or None; 0.15 s a call``."""
    parts = [f"{run.kinds[kind]} {_emphasized(kind)}" for kind in KINDS if run.kinds[kind]]
    if run.kinds["right"] == len(SESSION):
        parts = ["all right"]
    if run.again:
        parts.append(f"**{run.again} sent again**")
    mean = sum(run.seconds) / len(run.seconds) if run.seconds else 0.0
    return ", ".join(parts) + (f"; {_time(mean)} a call" if mean >= NOTICEABLE else "")


def _emphasized(kind: str) -> str:
    return f"**{kind}**" if kind in (WRONG, "exception", "not ended") else kind


def _time(seconds: float) -> str:
    return f"{seconds * 1e3:.0f} ms" if seconds < 0.1 else f"{seconds:.2f} s"


if __name__ == "__main__":
    main()
