"""Run the tester that fits a subject."""

from __future__ import annotations

from cobotwire.conformance import Report
from defects.arm.closed_loop import CORRECT as WAYS
from defects.clients import report_on_client
from defects.devices import report_on_firmware, report_on_peer
from defects.makers_server import report_on_server

LINES = ("", "lost", "late", "noise", "text", "split", "twice", "merged")
# The lines or variants with which each subject without a defect must conform. The maker's server
# is left out: it has defects of its own.
CORRECT = {
    "arm": ("",),
    "closed_loop": tuple(WAYS),
    "two_arms": ("",),
    "firmware": ("",),
    "client": LINES,
    "c_client": LINES,
}


def report_on(subject: str, defect: str = "", line: str = "") -> Report:
    """Test a subject with a defect.

    For a client, ``line`` names the fault of the referee's replies. For an arm in a closed loop
    without a defect it names the correct variant.
    """
    if subject in ("client", "c_client"):
        return report_on_client(subject, defect, line)
    if subject == "firmware":
        return report_on_firmware(defect)
    if subject == "server":
        return report_on_server(defect)
    return report_on_peer(subject, defect or line)
