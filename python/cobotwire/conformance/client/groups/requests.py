"""A client sends one request at a time, each change once, and no motion to an arm without power.

It does not repeat a query while the reply may still come.
"""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.conformance.client.history import History, Received
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.conformance.tally import Observation
from cobotwire.protocol.addresses import devices_of
from cobotwire.protocol.roles import is_of_gripper, starts_motion

NOTES = "field notes: a reply comes within about 30 ms or never"
# The longest observed delay of a reply, in seconds.
LATEST = 0.727

AWAITED = TestCase(
    "reply-awaited",
    "While a request awaits its reply, no other request with a reply is sent.",
    NOTES,
    timed=True,
)
GIVEN_TIME = TestCase(
    "reply-given-time",
    "A request is not repeated while its reply may still come.",
    NOTES,
    timed=True,
)
LATE_EXPECTED = TestCase(
    "late-reply-expected",
    "No request is sent while a late reply could be mistaken for its reply.",
    "field notes: a reply was seen 727 ms after its request",
    timed=True,
)

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


def _waiting(history: History, now: Received) -> Iterator[Observation]:
    """Check a request that comes while another one still awaits its reply.

    Frames carry no sequence numbers, so a reply cannot be assigned to one of two outstanding
    requests. One-way requests are legal at any time, because a stop must not wait.
    """
    if not now.awaits_reply:
        return
    awaited = given_time = ""
    for other in history.unreplied(now.at - history.patience, LATEST):
        after = f"{(now.at - other.at) * 1000:.1f} ms"
        if other.data == now.data:
            given_time = given_time or f"sent again after {after}"
        else:
            awaited = awaited or f"sent {after} after {other.name}, which still awaited its reply"
    yield Observation(AWAITED, awaited)
    yield Observation(GIVEN_TIME, given_time)


def _late_replies(history: History, now: Received) -> Iterator[Observation]:
    """Check a request if a late reply to another request could be taken for its reply."""
    if not now.awaits_reply:
        return
    complaint = ""
    for other in history.outstanding(now.at - LATEST):
        after = now.at - other.at
        if after >= history.patience and other.data != now.data and _alike(history, other, now):
            sent = other.data.hex(" ").upper()
            complaint = (
                f"sent {1000 * after:.0f} ms after {sent}; a late reply to that would look the same"
            )
            break
    yield Observation(LATE_EXPECTED, complaint)


def _alike(history: History, other: Received, now: Received) -> bool:
    """Return whether neither an address nor an echo distinguishes the replies to two requests.

    An echo counts only if every variant of the reply has it: older firmware omits it.
    """
    if other.command is None or now.command is None or other.command.id != now.command.id:
        return False
    table = history.codec.table
    addresses = {table.frame.address(each.data) for each in (other, now)}
    own = {device.value for device in devices_of(table)}
    if len(addresses) == 2 and addresses <= own:
        return False
    echoes = [any(field.echo for field in v.fields) for v in now.command.reply]
    return not echoes or not all(echoes)


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


WAITING = Group("waiting", (AWAITED, GIVEN_TIME), _waiting, subject="each request that has a reply")
LATE_REPLIES = Group(
    "late replies", (LATE_EXPECTED,), _late_replies, subject="each request that has a reply"
)
RESENDING = Group(
    "resending",
    (MOTION_RESENT, CHANGE_RESENT),
    _resending,
    subject="each request that changes something",
)
POWER = Group("power", (POWERED,), _power, subject="each motion")
