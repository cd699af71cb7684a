"""An error says which firmware a command needs if the arm has reported an older one."""

from __future__ import annotations

import asyncio
import pickle

import pytest

import vectors
from cobotwire import ReplyTimeout, editions
from cobotwire.client.firmware import ReportedFirmware
from cobotwire.editions.mycobot280 import AsyncMyCobot280, MyCobot280
from cobotwire.simulator import PtyServer, SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.memory import MemoryTransport
from cobotwire_codegen.render.robot_page import robot_pages

TABLE = editions.load("mycobot280").TABLE
STOP = "stop gets a reply since firmware 7.0, and the arm has reported 6.5"


def test_blocking_call_without_a_reply_names_the_firmware_once_the_version_is_known() -> None:
    clock = SteppedClock()
    simulated = SimulatedArm(TABLE, clock=clock, acks=False)
    with MyCobot280(MemoryTransport(simulated, clock)) as arm:
        with pytest.raises(ReplyTimeout) as unknown:
            arm.stop(ack_within=0.1)
        assert "firmware" not in str(unknown.value)
        assert arm.get_system_version() == 6.5
        with pytest.raises(ReplyTimeout) as known:
            arm.stop(ack_within=0.1)
    assert str(known.value).endswith(f"; {STOP}")
    assert str(pickle.loads(pickle.dumps(known.value))) == str(known.value)


def test_asyncio_call_without_a_reply_names_the_firmware() -> None:
    async def stopped(url: str) -> str:
        async with AsyncMyCobot280(url) as arm:
            await arm.get_system_version()
            with pytest.raises(ReplyTimeout) as known:
                await arm.stop(ack_within=0.02)
            return str(known.value)

    with PtyServer(SimulatedArm(TABLE, acks=False)) as server:
        assert asyncio.run(stopped(server.url)).endswith(f"; {STOP}")


@pytest.mark.parametrize(
    ("command", "version", "needs"),
    [
        ("backup_servo_params", 7.3, "backup_servo_params needs firmware 7.4, and the arm has"),
        ("backup_servo_params", 7.4, ""),
        ("jog_stop", 7.0, "jog_stop was removed in firmware 7.0, and the arm has reported 7.0"),
        ("jog_stop", 6.9, ""),
        ("stop", 7.0, ""),
        ("stop", None, ""),
        ("get_angles", 1.0, ""),
    ],
)
def test_error_names_the_firmware_only_if_the_version_of_the_arm_explains_it(
    command: str, version: float | None, needs: str
) -> None:
    firmware = ReportedFirmware()
    firmware.version = version
    found = firmware.needs(TABLE.command(command))
    assert found.startswith(needs)
    assert bool(found) is bool(needs)


def test_deltas_do_not_inherit_the_firmware_versions_of_their_base() -> None:
    stating = {
        name
        for name in editions.names()
        if any(command.firmware for command in editions.load(name).TABLE.commands)
    }
    assert stating == {"mycobot280", "myarm_c650", "myarm_m750"}


def test_page_of_a_robot_lists_changes_by_version_of_the_firmware() -> None:
    stated = [vectors.edition("mycobot280"), vectors.edition("mycobot320")]
    pages = {path.stem: text for path, text in robot_pages([(each, {}) for each in stated]).items()}
    _, _, section = pages["mycobot280"].partition("## Firmware versions")
    rows = [line.split(" | ")[:3] for line in section.partition("##")[0].splitlines()[6:]]
    assert rows[:4] == [
        ["| 7.0", "`jog_stop`", "removed"],
        ["| 7.0", "`stop`", "gets a reply"],
        ["| 7.4", "`backup_servo_params`", "new"],
        ["| 7.4", "`restore_servo_params`", "new"],
    ]
    _, _, section = pages["mycobot320"].partition("## Firmware versions")
    assert section.startswith("\n\nNo source states")
