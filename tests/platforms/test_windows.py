"""Import and use the package in a process that lacks what Windows lacks."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import PtyServer, SimulatedArm
from newcomer.installing import run

pytestmark = pytest.mark.skipif(
    sys.platform != "linux", reason="removes features of Linux, and reads /proc"
)

TESTS = Path(__file__).parents[1]
# The module of POSIX ports is chosen by os.name, so nothing imports it on Windows. The editions are
# generated from the same templates: one of them is enough.
IMPORT_ALL = """
import cobotwire, pkgutil, importlib
names = [m.name for m in pkgutil.walk_packages(cobotwire.__path__, "cobotwire.")]
others = "cobotwire.transport.serial.port", "cobotwire.transport.serial.linux"
names = [n for n in names if n not in others and not n.endswith("__main__")]
# The adapter for ROS 2 loads a library of this system.
names = [n for n in names if not n.startswith("cobotwire.adapters.ros2.")]
names = [n for n in names if not n.startswith("cobotwire.editions.") or "mycobot280." in n + "."]
for name in names:
    importlib.import_module(name)
import cobotwire.simulator
for name in cobotwire.simulator.__all__:
    getattr(cobotwire.simulator, name)
import cobotwire_codegen.cli
print(len(names) > 300)
"""
SERIAL = """
import sys, asyncio
from cobotwire import AsyncMyCobot280, MyCobot280
with MyCobot280(sys.argv[1]) as arm:
    arm.power_on()
    print(arm.is_power_on())
async def main():
    async with AsyncMyCobot280(sys.argv[1]) as arm:
        print(await arm.get_angles() == (0.0,) * 6)
asyncio.run(main())
"""
TCP = """
import asyncio
from cobotwire import AsyncMyCobot280, LinkError, MyCobot280
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import PtyServer, SimulatedArm, TcpServer
from cobotwire.simulator.local import local_server
with local_server(SimulatedArm(TABLE)) as server:
    print(server.url.partition(":")[0])
    with MyCobot280(server.url) as arm:
        arm.power_on()
        print(arm.is_power_on())
with TcpServer(SimulatedArm(TABLE).connect) as server:
    async def main():
        async with AsyncMyCobot280(server.url) as arm:
            print(await arm.is_power_on())
    asyncio.run(main())
try:
    PtyServer(SimulatedArm(TABLE))
except LinkError as error:
    print(error)
"""
FILES = """
import sys
from pathlib import Path
from cobotwire.capture.archive.stored import Stored
from cobotwire.capture.export.atomic_file import AtomicFile
from cobotwire.capture.export.inputs import Input
path = Path(sys.argv[1])
file = AtomicFile(path, overwrite=True)
file.file.write(b"0123456789")
file.publish()
print(path.read_bytes(), [p.name for p in path.parent.iterdir()])
with Stored(Input(str(path), 10)) as stored:
    print(stored.read(7, 9), stored.read(2, 3))
"""


def as_on_windows(script: str, *arguments: str, extras: str = "") -> list[str]:
    """Run a script in such a process; return the lines that it printed."""
    first = f"from platforms import windows; windows.pretend({extras})\n"
    command = [sys.executable, "-c", first + script]
    path = os.pathsep.join([str(TESTS), os.environ.get("PYTHONPATH", "")])
    done = run(*command, *arguments, env={**os.environ, "PYTHONPATH": path})
    assert done.stderr == ""
    return done.stdout.splitlines()


def test_every_module_can_be_imported() -> None:
    assert as_on_windows(IMPORT_ALL, extras="windows.EXTRAS") == ["True"]


def test_serial_port_is_read_and_written_by_pyserial() -> None:
    with PtyServer(SimulatedArm(TABLE)) as server:
        printed = as_on_windows(SERIAL, server.url)
    assert printed == ["True", "True"]


def test_simulated_arm_is_served_over_tcp_and_pty_is_refused() -> None:
    assert as_on_windows(TCP) == [
        "socket",
        "True",
        "False",
        "pty: this system has no pseudo-terminals: serve TCP instead",
    ]


def test_file_is_closed_before_it_is_renamed_and_read_by_offset(tmp_path: Path) -> None:
    printed = as_on_windows(FILES, str(tmp_path / "rows.bin"))
    assert printed == ["b'0123456789' ['rows.bin']", "b'789' b'234'"]


def test_simulated_windows_lacks_what_windows_lacks(tmp_path: Path) -> None:
    script = """
import os, select, sys
from pathlib import Path
from importlib import import_module
for name in ("termios", "fcntl"):
    try:
        import_module(name)
    except ModuleNotFoundError:
        print("no", name)
path = Path(sys.argv[1])
with path.open("w"):
    try:
        os.replace(path, path.with_suffix(".b"))
    except PermissionError:
        print("open")
try:
    select.select(os.pipe(), [], [], 0)
except OSError:
    print("pipe")
"""
    printed = as_on_windows(script, str(tmp_path / "a"))
    assert printed == ["no termios", "no fcntl", "open", "pipe"]
