"""Run the tester that fits a subject."""

from __future__ import annotations

from cobotwire.conformance import Report
from defects.arm.closed_loop import CORRECT as WAYS
from defects.clients import report_on_c_client, report_on_client
from defects.devices import (
    report_on_arm,
    report_on_closed_loop,
    report_on_firmware,
    report_on_two_arms,
)
from defects.makers_server import report_on_server

LINES = ("", "lost", "late", "noise", "text", "split", "twice", "merged")
# Where each subject must conform without a defect. The maker's server has its own defects.
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

    For a client, ``line`` names the fault of the referee's replies. For a subject without a defect
    it names the correct variant.
    """
    if subject == "client":
        return report_on_client(defect, line)
    if subject == "c_client":
        return report_on_c_client(defect, line)
    if subject == "closed_loop":
        return report_on_closed_loop(defect or line)
    by_subject = {
        "arm": report_on_arm,
        "two_arms": report_on_two_arms,
        "firmware": report_on_firmware,
        "server": report_on_server,
    }
    return by_subject[subject](defect)
