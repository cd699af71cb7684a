"""Failures that do not count, and verdicts of a step that did not come to its end."""

from __future__ import annotations

from collections.abc import Container, Mapping
from dataclasses import replace

from cobotwire.conformance.report import Cause, Result, Verdict

# What reasons say if nothing came, or nothing but the noise of a healthy line. The evidence may go
# on with a query that was replied to.
SILENCE = ("came nothing", "came no valid reply", "came noise ")


def excused(
    result: Result,
    reply_seconds: Mapping[str, list[float]],
    optional: Container[str],
    lacking: Mapping[str, str],
) -> Result:
    """Turn a failure by silence into not supported, if the device may lack the command.

    Args:
        result: the result.
        reply_seconds: the times of all valid replies, by command.
        optional: the commands that the device may lack altogether.
        lacking: what the device states that it does not support: by command, the reason.
    """
    if result.verdict is not Verdict.FAIL:
        return result
    silent = any(words in result.reason for words in SILENCE)
    stated = lacking.get(result.command, "") if silent else ""
    never = not reply_seconds.get(result.command)
    if not stated and not (never and result.command in optional):
        return result
    reason = f"The device states: {stated}." if stated else result.reason
    return replace(result, verdict=Verdict.INCONCLUSIVE, cause=Cause.NOT_SUPPORTED, reason=reason)


def cut_short(result: Result, why: str) -> Result:
    """Return a failure as it is, and anything else as not run."""
    if result.verdict is Verdict.FAIL:
        return result
    return replace(
        result, verdict=Verdict.NOT_RUN, cause=Cause.RUN_ENDED, reason=f"{why}.", evidence=()
    )
