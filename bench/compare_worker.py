"""Run rows of the speed benches on one tree, one round for each line of standard input.

A line is the name of a row. The answer is its seconds for a call, or ``-`` if the tree cannot run
it. The rows are those of this bench folder for every tree, so that two trees do the same work.
"""

from __future__ import annotations

import asyncio
import gc
import sys
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from pathlib import Path

import cobotwire
from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE
from responder import responder
from speed_rows import BULK, OBJECTS, SINGLE, THREADS, Row, Streams
from speed_table import Timed

# The calls over a pty that a round makes.
CALLS = 50


def main() -> None:
    """Answer each line; the first line out is the folder of the package."""
    streams = Streams(Path(sys.argv[1]))
    codec = codecs.load(TABLE, "native")
    print(Path(cobotwire.__file__).parent, flush=True)
    name, timed = "", None
    with ExitStack() as stack:
        client_rows = _client_rows(stack)
        for line in sys.stdin:
            if line.strip() != name:
                name, timed = line.strip(), None
                gc.collect()
                row = {**ROWS, **client_rows}[name]
                timed = _ready(partial(row, codec, streams))
            print(_seconds(timed), flush=True)


ROWS: dict[str, Row] = {**BULK, **OBJECTS, **SINGLE, **THREADS}
CLIENT_ROWS = ("blocking call", "asyncio call")


def _ready(make: Callable[[], Timed]) -> Timed | None:
    """Return the work of a row after a first run that fills memory; None if it fails."""
    try:
        timed = make()
        timed.work()
    except Exception as error:  # an older tree may lack what a row calls
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        return None
    return timed


def _seconds(timed: Timed | None) -> str:
    if timed is None:
        return "-"
    timed.run()
    return repr(timed.seconds.pop())


def _client_rows(stack: ExitStack) -> dict[str, Row]:
    """Return rows that call over a pty; the client is imported and opened on first use."""

    def blocking(*_: object) -> Timed:
        from client import RESPONDER
        from cobotwire.editions.mycobot280 import MyCobot280

        arm = stack.enter_context(MyCobot280(stack.enter_context(responder(RESPONDER))))
        return Timed(arm.get_angles, CALLS)

    def in_a_loop(*_: object) -> Timed:
        from client import RESPONDER
        from cobotwire.editions.mycobot280 import AsyncMyCobot280

        runner = stack.enter_context(asyncio.Runner())
        arm = AsyncMyCobot280(stack.enter_context(responder(RESPONDER)))
        runner.run(arm.__aenter__())
        stack.callback(lambda: runner.run(arm.__aexit__(None, None, None)))

        async def calls() -> None:
            for _ in range(CALLS):
                await arm.get_angles()

        return Timed(lambda: runner.run(calls()), scale=1 / CALLS)

    return dict(zip(CLIENT_ROWS, (blocking, in_a_loop)))


if __name__ == "__main__":
    main()
