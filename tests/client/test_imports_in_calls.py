"""Calls import nothing in their thread: Ctrl-C in an import could leave one of its locks held."""

from __future__ import annotations

import _thread
import json
import subprocess
import sys
import threading
from importlib import import_module
from pathlib import Path

import pytest

from cobotwire.editions.mercury_a1 import TABLE as MERCURY
from cobotwire.editions.mycobot280 import TABLE as TODAY
from cobotwire.protocol.lazy import import_aside
from cobotwire.protocol.table import Table
from cobotwire.simulator import PtyServer, SimulatedArm

# Prints each module that a call imported in the main thread, and which call that was.
CALLS = """
import asyncio, importlib, inspect, json, sys, threading
from contextlib import suppress
edition, url, kind, codec = sys.argv[1:]
package = importlib.import_module(f"cobotwire.editions.{edition}")
loop = asyncio.new_event_loop() if kind == "asyncio" else None
def run(result):
    if inspect.isawaitable(result):
        return loop.run_until_complete(result)
    return result
arm = (package.ASYNC_CLIENT if loop else package.CLIENT)(url, codec=codec, timeout=0.2)
if loop:
    loop.run_until_complete(arm.open())
seen, found, label = set(sys.modules), [], ""
def note(event, arguments):
    main = threading.current_thread() is threading.main_thread()
    if event == "import" and main and arguments[0] not in seen and arguments[0] != "readline":
        seen.add(arguments[0])
        found.append([label, arguments[0]])
sys.addaudithook(note)
def call(name, work):
    global label
    label = name
    try:
        run(work())
    except Exception as error:
        str(error)
async def first_of(stream):
    async for sample in stream:
        return sample
def sample():
    stream = arm.stream(package.GetAngles(), rate=20, timeout=0.1)
    return first_of(stream) if loop else next(stream)
call("stop", lambda: arm.stop())
for number in range(2):
    call("query", lambda: arm.get_angles())
call("not a number", lambda: arm.send_angles([float("nan")] * len(arm.table.joints), 1))
call("too fast", lambda: arm.send_angles([0] * len(arm.table.joints), 101))
call("move", lambda: arm.move_angles([1] * len(arm.table.joints), speed=100, timeout=0.2))
call("coordinates", lambda: arm.move_coords([100, 0, 200, 0, 0, 0], speed=100, timeout=0.2))
call("home", lambda: arm.go_home(timeout=0.2))
call("stream", sample)
call("events", lambda: arm.events(timeout=0.01).close())
call("handler", lambda: arm.on(int, print))
call("address", lambda: arm.at("lft"))
for command in arm.table.commands:
    method = getattr(arm, command.name, None)
    if method is not None and not command.event:
        # Without its arguments, if it has any.
        call(command.name, method)
call("close", lambda: arm.close())
call("closed", lambda: arm.get_angles())
print(json.dumps(found))
"""


@pytest.mark.parametrize(
    ("table", "kind", "codec"),
    [
        (TODAY, "blocking", "native"),
        (TODAY, "blocking", "reference"),
        (TODAY, "asyncio", "native"),
        (MERCURY, "blocking", "native"),
    ],
)
def test_calls_import_nothing_in_their_thread(table: Table, kind: str, codec: str) -> None:
    with PtyServer(SimulatedArm(table)) as server:
        command = [sys.executable, "-c", CALLS, table.edition, server.url, kind, codec]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == []


def test_ctrl_c_does_not_interrupt_an_import_in_another_thread(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "slow_to_import.py").write_text("import time\ntime.sleep(0.3)\nDONE = True\n")
    monkeypatch.syspath_prepend(tmp_path)
    threading.Timer(0.1, _thread.interrupt_main).start()
    with pytest.raises(KeyboardInterrupt):
        import_aside("slow_to_import")
    found: list[bool] = []
    other = threading.Thread(
        target=lambda: found.append(import_module("slow_to_import").DONE), daemon=True
    )
    other.start()
    other.join(5)
    assert found == [True]
