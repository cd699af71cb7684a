"""A client sends each change once, and never moves an arm that it has switched off."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.conformance.client.history import History, Received
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.conformance.tally import Observation
from cobotwire.protocol.roles import is_of_gripper, starts_motion

# Libraries that repeat a request do so within this time; people take longer.
AGAIN_SECONDS = 2.0
SAFETY = "safety class: only a query may be sent twice"

MOTION_RESENT = TestCase("motion-resent", "A motion is sent once.", SAFETY)
CHANGE_RESENT = TestCase("change-resent", "Any other change is sent once.", SAFETY)
POWERED = TestCase(
    "motion-powered",
    "No motion is sent to an arm that is switched off, or with all its joints released.",
    "safety class: power",
)


def _resending(history: History, now: Received) -> Iterator[Observation]:
    """Fail a change that repeats the previous one before its acknowledgement.

    An arm that received both makes a step twice. A repetition is legal after the
    acknowledgement, or if the client sent another change in between.
    """
    if now.command is None or not now.changes_state:
        return
    earlier = history.since(now.at - AGAIN_SECONDS)
    other = next((entry for entry in earlier if entry.changes_state), None)
    again = other is not None and other.data == now.data and other.replied_at is None
    complaint = f"sent again after {now.at - other.at:.3f} s" if other and again else ""
    yield Observation(MOTION_RESENT if now.command.safety == "motion" else CHANGE_RESENT, complaint)


def _power(history: History, now: Received) -> Iterator[Observation]:
    """Check a motion after the client itself has switched the arm off or released its joints."""
    table = history.codec.table
    if now.command is None or not starts_motion(table, now.command):
        return
    complaint = ""
    if not history.powered:
        complaint = "the arm was switched off and not on again"
    elif history.released and not is_of_gripper(table, now.command):
        complaint = "all joints were released, and none is held again"
    yield Observation(POWERED, complaint)


RESENDING = Group(
    "resending",
    (MOTION_RESENT, CHANGE_RESENT),
    _resending,
    subject="each request that changes something",
)
POWER = Group("power", (POWERED,), _power, subject="each motion")
