"""Run the device tester on independent arms: in plain Python, and on the firmware in C."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from pathlib import Path

from cobotwire.conformance import Report
from cobotwire.conformance.device import (
    DeviceConnection,
    Permissions,
    Step,
    Tester,
)
from cobotwire.conformance.device.started import StartedDevice
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.errors import LinkError
from cobotwire.protocol.loading import table_of
from cobotwire.protocol.table import Table
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.peer import Peer
from cobotwire.transport import Transport
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.publish import edition_json
from conformance.device.testing import on_peer
from defects.arm.closed_loop import closed_loop_arm
from defects.arm.planted import arm_with
from defects.arm.two_arms import TwoArms
from stalls import unstalled
from targets.c.compiled import compile_c, scratch, sources
from vectors import ROOT

HERE = Path(__file__).parent
# A reply is late after 500 ms; in seconds.
ALLOWED_STALL = 0.3
AT_REST = ("setting", "persistent-write", "power", "malformed")


def _table(name: str) -> Table:
    """Return an edition of the arms here."""
    edition = build_edition(HERE / "arm" / f"{name}.yaml", HERE)
    return table_of(json.loads(edition_json(edition)))


CLOSED_LOOP, TWO_ARMS = _table("closed_loop"), _table("two_arms")
# The arm does not support motion to coordinates.
LEFT_OUT = ("send_coord", "send_coords", "jog_coord")


class OurTester(Tester):
    """The tester, without the commands that the subject lacks."""

    def steps(self) -> Iterator[Step]:
        """Yield the steps."""
        for step in super().steps():
            if step.command is None or step.command.name not in LEFT_OUT:
                yield step


# The arms in plain Python, each with its edition.
ARMS: dict[str, tuple[Callable[[Callable[[], float], str], Peer], Table]] = {
    "arm": (arm_with, TABLE),
    "closed_loop": (closed_loop_arm, CLOSED_LOOP),
    "two_arms": (TwoArms, TWO_ARMS),
}


def report_on_peer(subject: str, switch: str = "") -> Report:
    """Test an arm in plain Python, in stepped time, with all permissions."""
    clock = SteppedClock()
    make, table = ARMS[subject]
    return on_peer(make(clock, switch), clock, table, OurTester).run()


def report_on_firmware(defect: str = "") -> Report:
    """Test the firmware in C, in real time, without motion.

    A run during which the machine stood still is repeated: its times say nothing about the device.
    """

    def run() -> Report:
        with StartedDevice([str(firmware(defect))], "port", TABLE.baudrate) as device:
            return report_on(device.transport, AT_REST)

    return unstalled(run, ALLOWED_STALL)


def report_on(transport: Transport, allow: Iterable[str]) -> Report:
    """Test the device on a transport, in real time, without motion."""
    allowed = Permissions.of(allow, joints=6)
    tester = OurTester(DeviceConnection(transport), TABLE, permissions=allowed)
    # The report says so if the connection is lost.
    with suppress(LinkError):
        tester.run()
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


def firmware(defect: str = "") -> Path:
    """Return the program of the firmware in C."""
    return built(HERE / "firmware" / "firmware.c", defect)
