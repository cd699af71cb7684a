"""What to do about what was found."""

from __future__ import annotations

from typing import NamedTuple

from cobotwire.diagnose import Summary


class Complaint(NamedTuple):
    """One thing that is not as it should be.

    ``grave`` is False for what only should be known: an arm without power is not ill.
    """

    kind: str
    says: str
    advice: str
    grave: bool = True


SUPPLY = (
    "its program failed, or its power: check the supply and the plug, then the firmware's version"
)
# By kind of finding; the order is that in which one would look after them.
NOISE: dict[str, str] = {
    "panic": SUPPLY,
    "boot": SUPPLY,
    "nuls": SUPPLY,
    "cmd-len-error": "the arm hears damaged requests: does another program write to this port "
    "(lsof PORT)? is the cable long, or the hub without power?",
    "garbage": "the baud rate may be another one: try --baudrate 1000000, or 115200",
    "damaged-frame": "bytes get lost: try another cable or USB socket, and look for a second "
    "program that reads from this port",
    "unlisted-frame": "the firmware may speak another edition: try --edition mycobot280",
    "other-way": "the line echoes what is sent, or another host talks on it; answers are matched "
    "all the same, but turn the bridge's echo off where you can",
    "servo": "the firmware lets its servo bus through; nothing is lost by it here, but programs "
    "that trust the line will stumble: a newer firmware may not do it",
    "text": "the firmware prints messages; nothing is lost by it here",
    "unrecognised": "record it (--record FILE) and look at it with cobotwire decode FILE",
}
SILENT = (
    "is its power on, the emergency stop released, and on M5 versions Transponder chosen on the "
    "screen? is it this port (cobotwire ports)? is the baud rate 1000000 or 115200 (--baudrate)?"
)
LOST = "asking again makes up for it; look for what else is found here, then at cable and hub"
LATE = "the arm is busy or the line is slow: give it more time (timeout=), ask less often"
ILLEGAL = "the firmware may speak another edition: try --edition mycobot280"
NO_POWER = "cobotwire call power_on gives it power; stand clear"
BUSY_TIMER = (
    "echo 1 | sudo tee {path}   (cobotwire asks for it when it opens a port; it was refused)"
)
SLOW = "if this is a USB adapter, its latency timer may be at 16 ms; it should be at 1 ms"
LINK = "is the cable plugged in? cobotwire ports lists what there is; another program may have it"


def complaints_of(findings: Summary) -> list[Complaint]:
    """A complaint for each kind of noise that was heard."""
    return [
        Complaint(kind, f"{findings.kinds[kind]} x {kind}", advice, grave=kind != "text")
        for kind, advice in NOISE.items()
        if findings.kinds[kind]
    ]
