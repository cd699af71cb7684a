"""Make a case's calls with one client of any library, and return how each call ended."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from functools import partial
from importlib import import_module
from typing import Any, NamedTuple

from both_ways import InLoop
from cobotwire import CobotwireError
from cobotwire.editions.mycobot280 import AsyncMyCobot280, MyCobot280
from field_notes.case import DONE, Call, Case
from probe_client import NODE, ProbeClient

RIGHT, WRONG = "right", "wrong, silently"


class Outcome(NamedTuple):
    """How a call ended.

    Attributes:
        verdict: ``right``, ``wrong, silently``, ``-1``, ``None`` or the name of an error.
        detail: the value, or the text of the error.
        meant: whether the library, or the system, raised the error on purpose.
    """

    verdict: str
    detail: str
    meant: bool = True


def _opened(library: str) -> Callable[[str], Any]:
    """Return a function that imports a library with the maker's classes, and opens an arm."""

    def opened(url: str) -> Any:
        module = import_module(library)
        if url.startswith("socket://"):
            host, port = url.removeprefix("socket://").split(":")
            return module.MyCobot280Socket(host, int(port))
        return module.MyCobot280(url, "115200")

    return opened


# Clients that have the maker's methods, and no `with`.
AS_LIBRARY = {"layer", "pymycobot"}
# Clients in Rust and Node run in their own process; asyncio's runs in an event loop in a thread.
OPENERS: dict[str, Callable[[str], Any]] = {
    "blocking": MyCobot280,
    "asyncio": partial(InLoop, AsyncMyCobot280),
    "rust": partial(ProbeClient, edition="mycobot280"),
    "rust async": partial(ProbeClient, edition="mycobot280", tasks=True),
    "node": partial(ProbeClient, edition="mycobot280", command=NODE),
    "layer": _opened("cobotwire.pymycobot"),
    "pymycobot": _opened("pymycobot"),
}


def play(case: Case, library: str, url: str, client: int = 0) -> tuple[list[Outcome], float]:
    """Make all calls of a client; return how they ended, and the seconds that they took.

    The time does not include opening.
    """
    try:
        arm = OPENERS[library](url)
    except Exception as error:
        return [_failed(error)], 0.0
    options = library in AS_LIBRARY
    started = time.monotonic()
    if case.threads:
        outcomes = _in_threads(case, arm, options)
    else:
        outcomes = _in_turn(case.calls[client :: case.clients], case, arm, options)
    seconds = time.monotonic() - started
    if library not in AS_LIBRARY:
        arm.__exit__(None, None, None)
    return outcomes, seconds


def _in_turn(calls: tuple[Call, ...], case: Case, arm: Any, options: bool) -> list[Outcome]:
    outcomes: list[Outcome] = []
    for _ in range(case.repeat):
        for call in calls:
            outcome = called(call, arm, options)
            if case.unread and outcome.verdict == RIGHT:
                continue
            outcomes.append(outcome)
            if case.unread:
                return outcomes
    return outcomes


def _in_threads(case: Case, arm: Any, options: bool) -> list[Outcome]:
    outcomes: list[Outcome] = []

    def work(call: Call) -> None:
        outcomes.extend(_in_turn((call,), case, arm, options))

    threads = [threading.Thread(target=work, args=(call,)) for call in case.calls]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return outcomes


def called(call: Call, arm: Any, options: bool) -> Outcome:
    """Make one call, with its ``pymycobot_options`` if ``options``; return how it ended."""
    try:
        value = getattr(arm, call.method)(
            *call.arguments, **(call.pymycobot_options if options else {})
        )
    except Exception as error:
        return _failed(error)
    return _outcome(call, value)


def _outcome(call: Call, value: Any) -> Outcome:
    plain = list(value) if isinstance(value, tuple) else value
    if plain == call.right or call.right == DONE:
        return Outcome(RIGHT, repr(plain))
    if plain is None or plain == -1:
        return Outcome(repr(plain), "")
    return Outcome(WRONG, repr(plain))


def _failed(error: Exception) -> Outcome:
    kind = type(error)
    ours = kind.__module__ in ("builtins", "cobotwire.protocol.errors")
    name = kind.__name__ if ours else f"{kind.__module__.split('.')[0]}.{kind.__name__}"
    return Outcome(name, str(error), isinstance(error, CobotwireError | OSError))
