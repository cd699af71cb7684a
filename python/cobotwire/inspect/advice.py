"""Say what to do about each problem that an examination can find."""

from __future__ import annotations

from typing import NamedTuple

from cobotwire.diagnose import Summary


class Problem(NamedTuple):
    """A problem, and what to do about it.

    ``serious`` is False for what is only worth knowing, for example that the arm has no power.
    """

    kind: str
    text: str
    advice: str
    serious: bool = True


CONTROLLER = (
    "the controller's program or its power failed: check the power supply and its plug, then "
    "update the firmware"
)
# By kind of finding, in the order in which to look into them.
NOISE: dict[str, str] = {
    "panic": CONTROLLER,
    "boot": CONTROLLER,
    "nuls": CONTROLLER,
    "cmd-len-error": "the arm receives damaged requests: check whether another program writes to "
    "this port (lsof PORT), whether the cable is too long, and whether the hub has power",
    "garbage": "the baud rate may be wrong: try --baudrate 1000000 or --baudrate 115200",
    "damaged-frame": "bytes get lost: try another cable or USB socket, and check whether another "
    "program reads from this port",
    "unlisted-frame": "the firmware may use another edition: try --edition mycobot280",
    "opposite-frame": "the line echoes what is sent, or another host uses it; replies are matched "
    "all the same, but turn the adapter's echo off if you can",
    "servo": "the firmware leaks packets of its servo bus; cobotwire skips them, but programs that "
    "expect clean replies may fail: try a newer firmware",
    "text": "the firmware prints messages; cobotwire skips them",
    "unrecognised": "record the traffic (--record FILE), and inspect it with cobotwire decode FILE",
}
NO_REPLIES = (
    "check that the arm has power, that its emergency stop is released, that an M5 version shows "
    "Transponder on its screen, that this is the right port (cobotwire ports), and that the baud "
    "rate is right (--baudrate 1000000 or 115200)"
)
LOST = "retries make up for it; fix the other problems listed here, then check cable and hub"
LATE = "the arm is busy or the line is slow: use a longer timeout=, or send fewer requests"
ILLEGAL = "the firmware may use another edition: try --edition mycobot280"
NO_POWER = "cobotwire call power_on switches it on; keep clear of the arm"
LATENCY_TIMER = "echo 1 | sudo tee {path}   (cobotwire tried this when it opened the port)"
SLOW = "if this is a USB adapter, its latency timer may be 16 ms; set it to 1 ms"
PORT = (
    "check that the cable is plugged in (cobotwire ports lists the ports), and that no other "
    "program uses the port"
)


def problems_in(findings: Summary) -> list[Problem]:
    """Return a problem for each kind of finding."""
    return [
        Problem(kind, f"{findings.kinds[kind]} x {kind}", advice, serious=kind != "text")
        for kind, advice in NOISE.items()
        if findings.kinds[kind]
    ]
