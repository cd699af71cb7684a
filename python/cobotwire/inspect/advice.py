"""Say what to do about each problem that an examination can find."""

from __future__ import annotations

from typing import NamedTuple

from cobotwire.diagnose import CLASSES, Summary


class Problem(NamedTuple):
    """A problem, and what to do about it.

    ``serious`` is False for what is only worth knowing, for example that a round trip is slow.
    """

    kind: str
    text: str
    advice: str
    serious: bool = True


NO_REPLIES = (
    "check that the arm has power, that its emergency stop is released, that an M5 version shows "
    "Transponder on its screen, that this is the right port (cobotwire ports), and that the baud "
    "rate is right (--baudrate 1000000 or 115200)"
)
LOST = "retries make up for it; fix the other problems listed here, then check cable and hub"
NO_COORDS = (
    "without a geometry, a simulated arm sends no coordinates; if this arm is real, the reply was "
    "lost"
)
LATE = "the arm is busy or the line is slow: use a longer timeout=, or send fewer requests"
ILLEGAL = "the firmware may use another edition: cobotwire identify {url} finds out"
VALUES = "do not move the arm with this edition; cobotwire survey {url} -o survey.zip shows more"
OTHER_EDITION = "use cobotwire --edition {edition}; in a program, cobotwire.connect(port)"
LATENCY_TIMER = "echo 1 | sudo tee {path}   (cobotwire tried this when it opened the port)"
SLOW = "if this is a USB adapter, its latency timer may be 16 ms; set it to 1 ms"
PORT = (
    "check that the cable is plugged in (cobotwire ports lists the ports), and that no other "
    "program uses the port"
)


def problems_in(findings: Summary) -> list[Problem]:
    """Return a problem for each kind of finding, the most important first."""
    return [
        Problem(each.kind, f"{findings.kinds[each.kind]} x {each.kind}", each.advice, each.serious)
        for each in CLASSES
        if findings.kinds[each.kind]
    ]
