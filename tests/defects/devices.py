"""Run the device tester on independent arms: in plain Python, and on the firmware in C."""

from __future__ import annotations

import subprocess
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from cobotwire.conformance import Report
from cobotwire.conformance.device import DeviceConnection, Permissions, Step, Tester
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.errors import LinkError
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.memory import MemoryTransport
from cobotwire.transport import open_transport
from cobotwire_codegen.build import build_edition
from defects.arm.planted import arm_with
from targets.c.compiled import compile_c, scratch, sources
from vectors import ROOT

HERE = Path(__file__).parent
AT_REST = ("setting", "persistent-write", "power", "malformed")
# Not built in the arm: motion to coordinates.
LEFT_OUT = ("send_coord", "send_coords", "jog_coord")


class _Tester(Tester):
    """The tester, without the commands that the subject lacks."""

    def steps(self) -> Iterator[Step]:
        """Yield the steps."""
        for step in super().steps():
            if step.command is None or step.command.name not in LEFT_OUT:
                yield step


def report_on_arm(defect: str = "") -> Report:
    """Test the arm in plain Python, in stepped time, with motion."""
    clock = SteppedClock()
    connection = DeviceConnection(MemoryTransport(arm_with(clock, defect), clock), clock)
    allowed = Permissions.of(
        (*AT_REST, "motion"),
        joints=6,
        max_speed=60,
        workspace=dict.fromkeys(range(1, 7), (-60.0, 60.0)),
    )
    return _Tester(connection, TABLE, permissions=allowed).run()


def report_on_firmware(defect: str = "") -> Report:
    """Test the firmware in C, in real time, without motion."""
    with running_firmware(defect) as port:
        return report_on_port(port, AT_REST)


def report_on_port(port: str, allow: Iterable[str]) -> Report:
    """Test what is at a port, in real time, without motion."""
    transport = open_transport(port, TABLE.baudrate)
    allowed = Permissions.of(allow, joints=6)
    tester = _Tester(DeviceConnection(transport), TABLE, permissions=allowed)
    try:
        # The report says so if the connection is lost.
        with suppress(LinkError):
            tester.run()
    finally:
        with suppress(LinkError):
            transport.close()
    return tester.report


def built(source: Path, defect: str) -> Path:
    """Compile a program on the generated code of the edition, with the flag of a defect."""
    folder = sources(build_edition(ROOT / "spec" / "editions" / "mycobot.yaml", ROOT))
    program = scratch() / f"{source.stem}-{defect or 'correct'}"
    if not program.exists():
        flags = [f"-DDEFECT_{defect}"] if defect else []
        files = [str(source), str(folder / "mycobot.c")]
        compile_c("gcc", "-O1", *flags, f"-I{folder}", *files, "-lm", "-o", str(program))
    return program


@contextmanager
def running_firmware(defect: str = "") -> Iterator[str]:
    """Run the firmware while the block runs; the port is the first line that it prints."""
    program = built(HERE / "firmware" / "firmware.c", defect)
    with subprocess.Popen(
        [str(program)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as process:
        assert process.stdout is not None
        try:
            yield process.stdout.readline().strip()
        finally:
            process.kill()
