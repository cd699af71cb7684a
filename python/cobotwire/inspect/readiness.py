"""Find out whether an arm obeys a motion, and what to do if it does not."""

from __future__ import annotations

from collections.abc import Mapping
from shlex import quote
from typing import Any

from cobotwire.client import Client
from cobotwire.inspect.advice import Problem
from cobotwire.protocol.errors import ArmNotReady, ReplyTimeout, no_power, with_meaning
from cobotwire.protocol.table import Command, Role, Table
from cobotwire.session.motion import error_meaning

# The queries that tell whether an arm obeys a motion.
ROLES: tuple[Role, ...] = ("powered", "paused", "error")


def problems(table: Table, states: Mapping[Role, Any], url: str) -> list[Problem]:
    """Return what keeps an arm from moving; ``states`` are the results of the queries in ROLES.

    ``url`` is its port. A state that is missing or None is not known, and is not a problem.
    """
    found = []
    powered = states.get("powered")
    if powered is not None and not powered:
        advice = _use(url, table, "powered", 1, "switches it on; keep clear of the arm")
        if powered != 0:
            advice = f"end that state first; then {advice}"
        found.append(Problem("no-power", f"the arm has {no_power(powered)}", advice))
    if states.get("paused"):
        stop = table.find_role("stop")
        discard = f"; {_call(url, stop)} discards it" if stop else ""
        advice = _use(url, table, "paused", 0, "continues the old motion at once") + discard
        found.append(Problem("paused", "the arm's motion is paused", advice))
    if states.get("error"):
        error = states["error"]
        text = f"the arm's error register is {with_meaning(error, error_meaning(table, error))}"
        advice = "find the cause; then " + _use(url, table, "error", 0, "clears the error")
        found.append(Problem("error-register", text, advice))
    return found


def check_ready(arm: Client, name: str, url: str) -> None:
    """Query whether the arm obeys the motion of that name; ``url`` is its port, for the advice.

    If only some queries get no reply, as from firmware that lacks one, their states are not known.

    Raises:
        ArmNotReady: the arm has no power, is paused, or reports an error.
        ReplyTimeout: the arm did not reply to the first query.
    """
    states: dict[Role, Any] = {}
    for role in ROLES:
        query = arm.table.find_role(role)
        if query is None:
            continue
        try:
            states[role] = _ask(arm, query)
        except ReplyTimeout:
            if not states:
                raise
    _raise_for(name, problems(arm.table, states, url), sent=False)


def check_accepted(arm: Client, name: str, url: str) -> None:
    """Query the error register after a motion was sent; no reply is not an error.

    Raises:
        ArmNotReady: the register holds an error.
    """
    query = arm.table.find_role("error")
    if query is None:
        return
    try:
        error = _ask(arm, query)
    except ReplyTimeout:
        return
    _raise_for(name, problems(arm.table, {"error": error}, url), sent=True)


def _ask(arm: Client, query: Command) -> Any:
    return getattr(arm, query.name)()


def _raise_for(name: str, found: list[Problem], *, sent: bool) -> None:
    if found:
        texts = tuple(f"{problem.text}; {problem.advice}" for problem in found)
        raise ArmNotReady(name, sent, texts)


def _use(url: str, table: Table, role: Role, raw: int, effect: str) -> str:
    command = table.find_setter(role, raw)
    return f"{_call(url, command)} {effect}" if command else "see the arm's manual"


def _call(url: str, command: Command) -> str:
    return f"cobotwire call {quote(url)} {command.name}"
