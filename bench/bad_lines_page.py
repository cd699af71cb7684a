"""Rate the outcomes of each run, and format them as the page of bad lines."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from field_notes.case import DONE, Case
from field_notes.cases import GROUPS
from field_notes.play import RIGHT, WRONG, Outcome

BEGIN, END = "<!-- begin: make table -->", "<!-- end: make table -->"
TRANSPORTS = {"pty": "pty", "tcp": "TCP"}
TITLES = {
    "blocking": "blocking",
    "asyncio": "asyncio",
    "layer": "cobotwire.pymycobot",
    "pymycobot": "pymycobot 4.0.7",
}
# Seconds; shorter runs are shown without a time.
NOTICEABLE = 0.5
KINDS = ("right", "honest error", "-1 or None", "crash", WRONG, "sent too often", "hang")


@dataclass(frozen=True)
class Row:
    """The outcome of one case with one client."""

    case: Case
    outcomes: list[Outcome]
    seconds: float
    frames: list[bytes]
    garbled: int
    hung: bool

    def kinds(self) -> Counter[str]:
        """Count how many calls ended in each way."""
        kinds = Counter(self._kind(outcome) for outcome in self.outcomes)
        if self.hung:
            kinds["hang"] += 1
        return kinds

    def worst(self) -> str:
        """Return the worst way in which a call ended; the summary counts the run as this."""
        return max(self.kinds(), key=KINDS.index)

    def _kind(self, outcome: Outcome) -> str:
        if outcome.verdict in (RIGHT, "-1", "None") and self._wrong_on_the_line():
            return WRONG
        if outcome.verdict in (RIGHT, "-1", "None") and self._too_often():
            return "sent too often"
        if outcome.verdict in (RIGHT, WRONG):
            return outcome.verdict
        if outcome.verdict in ("-1", "None"):
            return "-1 or None"
        return "honest error" if outcome.meant else "crash"

    def _one_way(self) -> list[bytes]:
        return [call.sends for call in self.case.calls if call.right == DONE and call.sends]

    def _wrong_on_the_line(self) -> bool:
        return any(request not in self.frames for request in self._one_way())

    def _too_often(self) -> bool:
        return any(self.frames.count(request) > 1 for request in self._one_way())

    def text(self, limit: float) -> str:
        """Return the whole outcome."""
        parts = [self._ends(), self.time(limit), self._requests()]
        return ", ".join(part for part in parts if part)

    def briefly(self) -> str:
        """Return the outcome without its time and without long values."""
        ends = re.sub(r": \[.{20,}\]$", "", self._ends())
        return ", ".join(part for part in (ends, self._requests()) if part)

    def _ends(self) -> str:
        described = Counter(self._described(outcome) for outcome in self.outcomes)
        if self.hung:
            described["**hangs**"] += 1
        if self._by_chance():
            order = sorted(self.outcomes, key=lambda outcome: KINDS.index(self._kind(outcome)))
            return f"from {self._described(order[0])} to {self._described(order[-1])}"
        return "; ".join(described if len(described) < len(self.outcomes) else described.elements())

    def _by_chance(self) -> bool:
        """Return whether many calls end in different ways, so that counts vary from run to run."""
        return len(self.outcomes) > 3 and len({self._kind(one) for one in self.outcomes}) > 1

    def _described(self, outcome: Outcome) -> str:
        kind = self._kind(outcome)
        if kind == "right":
            return "right"
        if kind == "sent too often":
            return f"gives {outcome.verdict if outcome.verdict != RIGHT else outcome.detail}"
        if kind == WRONG and outcome.verdict != WRONG:
            return f"**wrong, silently**: {self.frames[0].hex(' ').upper()} sent"
        if kind == WRONG:
            value = "" if len(self.outcomes) > 3 else f": {outcome.detail}"
            return f"**wrong, silently**{value}"
        return f"**{outcome.verdict}**" if kind == "crash" else outcome.verdict

    def time(self, limit: float) -> str:
        """Return the time of all calls; empty if chance decides it."""
        if self.hung:
            return f"ended after {limit:.0f} s"
        if self._by_chance():
            return ""
        return "< 0.1 s" if self.seconds < 0.095 else f"{self.seconds:.1f} s"

    def _requests(self) -> str:
        calls = len(self.case.calls) * self.case.repeat
        garbled = f", {self.garbled} bytes garbled" if self.garbled else ""
        requests = len(self.frames)
        if self.case.unread or self._by_chance() or (requests == calls and not garbled):
            return ""
        often = f"{requests} request{'s' if requests > 1 else ''} for {calls} calls"
        if calls == 1:
            often = {2: "sent twice"}.get(requests, f"sent {requests} times")
        return f"**{often}**{garbled}" if self._too_often() else often + garbled


Results = Mapping[tuple[str, str, str], Row]


def page(results: Results, clients: tuple[str, ...], limit: float) -> str:
    """Return the generated part of the page; the last of the clients is the peer."""
    parts = [BEGIN, _summary(results, clients)]
    for title, cases in GROUPS.items():
        parts.append(f"### {title}")
        parts.append(_cases(cases, results, clients, limit))
    parts.append(END)
    return "\n\n".join(parts) + "\n"


def _summary(results: Results, clients: tuple[str, ...]) -> str:
    runs = len(results) // len(clients)
    lines = [
        f"| worst outcome of a run ({runs} runs) | "
        + " | ".join(TITLES[who] for who in clients)
        + " |"
    ]
    lines.append("|---|" + "---|" * len(clients))
    counts = {
        who: Counter(row.worst() for (_, _, by), row in results.items() if by == who)
        for who in clients
    }
    for kind in KINDS:
        cells = " | ".join(str(counts[who][kind]) for who in clients)
        lines.append(f"| {kind} | {cells} |")
    return "\n".join(lines)


def _cases(
    cases: tuple[Case, ...], results: Results, clients: tuple[str, ...], limit: float
) -> str:
    """Return the outcomes of our clients and of the peer; cases with equal ones share an entry."""
    *ours, peer = clients
    entries: dict[tuple[str, str], list[str]] = {}
    for case in cases:
        of_peer = {TRANSPORTS[each]: [results[case.name, each, peer]] for each in case.transports}
        of_ours = {
            TITLES[who]: [results[case.name, each, who] for each in case.transports] for who in ours
        }
        ends = (_ends(of_ours, limit, first=""), _ends(of_peer, limit, first="pty: "))
        entries.setdefault(ends, []).append(f"{case.name} ({case.line})")
    lines = []
    for (our_ends, their_ends), names in entries.items():
        lines.append(f"- {'; '.join(names)}")
        if our_ends == their_ends:
            lines.append(f"  - both: {our_ends}")
        else:
            lines += [f"  - cobotwire: {our_ends}", f"  - pymycobot: {their_ends}"]
    return "\n".join(lines)


def _ends(runs: Mapping[str, list[Row]], limit: float, first: str) -> str:
    """Return each outcome of the runs; if they differ, with labels: ``first``, then their own."""
    alike: dict[str, tuple[list[str], list[Row]]] = {}
    for label, rows in runs.items():
        for row in rows:
            labels, found = alike.setdefault(row.briefly(), ([], []))
            labels.append(label)
            found.append(row)
    texts = [f"{text}{_longest(rows, limit)}" for text, (_, rows) in alike.items()]
    names = [", ".join(dict.fromkeys(labels)) for labels, _ in alike.values()]
    others = [f"{name}: {text}" for name, text in zip(names[1:], texts[1:])]
    return ". ".join([f"{first if others else ''}{texts[0]}", *others])


def _longest(rows: list[Row], limit: float) -> str:
    """Return the time of the longest run, if it is noticeable."""
    longest = max(rows, key=lambda row: row.seconds)
    time = longest.time(limit) if longest.seconds >= NOTICEABLE else ""
    return f", {time}" if time else ""
