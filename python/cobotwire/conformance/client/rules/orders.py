"""Rules for orders: each once, and none to an arm that was switched off."""

from __future__ import annotations

from cobotwire.conformance.client.past import Heard, Past
from cobotwire.conformance.client.rules.rule import Judgement, rule

# Libraries that send again do so within this time; people take longer.
AGAIN_SECONDS = 2.0
SAFETY = "safety class: only a query may be sent twice"


@rule("motion-resent", "a motion is sent once", SAFETY)
def motion_resent(past: Past, now: Heard) -> Judgement:
    """The same motion again, while the first was not acknowledged: a step would be made twice."""
    return _resent(past, now, motion=True)


@rule("order-resent", "an order is sent once", SAFETY)
def order_resent(past: Past, now: Heard) -> Judgement:
    """The same for all other orders."""
    return _resent(past, now, motion=False)


def _resent(past: Past, now: Heard, motion: bool) -> Judgement:
    if not now.is_order or now.command is None or (now.command.safety == "motion") != motion:
        return None
    for other in past.backwards(now.at - AGAIN_SECONDS):
        if not other.is_order:
            continue
        # What was acknowledged may be wanted again, and so may what stood before another order.
        if other.data != now.data or other.answered_at is not None:
            return ""
        return f"sent again after {now.at - other.at:.3f} s"
    return ""


@rule("motion-powered", "no motion is sent to an arm that was switched off", "safety class: power")
def motion_powered(past: Past, now: Heard) -> Judgement:
    """The client itself has switched it off."""
    if now.command is None or now.command.safety != "motion":
        return None
    return "" if past.powered else "the arm was switched off, and not on again"
