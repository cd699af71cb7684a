"""What a session leaves on its port is respected by the next one, of any process."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from both_ways import InLoop
from cobotwire import LinkError, MyCobot, ReplyTimeout
from cobotwire.client import port_memory
from cobotwire.client.port_memory import PortMemory
from cobotwire.editions.mycobot import AsyncMyCobot
from cobotwire.editions.mycobot280 import MyCobot280
from cobotwire.session.alignment import Part
from cobotwire.session.leftover import LateFrame, Leftover
from cobotwire.transport import open_transport
from command_line import run_program
from scripted_peer import ScriptedPeer
from slow_arm import SlowArm
from stuck_pty import ANGLES, MOTION, STOP, StuckPty, frames

LATE = 0.75
GET_ENCODER = bytes.fromhex("FE FE 03 3B 01 FA")
BOTH = [MyCobot, lambda port, **options: InLoop(AsyncMyCobot, port, **options)]


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder of the notes, which other tests do not use."""
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    return tmp_path / f"cobotwire-{os.getuid()}"


@pytest.fixture
def late_arm() -> Iterator[SlowArm]:
    arm = SlowArm({1: LATE})
    yield arm
    arm.close()


@pytest.mark.parametrize("who", BOTH)
def test_late_reply_to_a_closed_client_is_not_used_by_the_next_one(
    late_arm: SlowArm, who: Callable[..., Any]
) -> None:
    with who(late_arm.url, timeout=0.3) as arm, pytest.raises(ReplyTimeout):
        arm.get_encoder(1)
    with who(late_arm.url) as arm:
        assert arm.get_encoder(2) == 2


def test_late_reply_to_one_program_is_not_printed_by_the_next_one(folder: Path) -> None:
    # So late that the next program has started by then.
    arm = SlowArm({1: 0.95})
    first = run_program("call", arm.url, "get_encoder", "1")
    assert "no reply" in first.stderr
    assert len(list(folder.iterdir())) == 1, "the program leaves a note"
    second = run_program("call", arm.url, "get_encoder", "2")
    assert second.stdout.strip() == "2", second
    arm.close()


def test_half_a_request_of_a_closed_client_is_ended_by_the_next_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pty, whole, written = StuckPty(), 0, None
    with MyCobot280(pty.url) as arm:
        while written is None:
            try:
                arm.send_angles(ANGLES, 50)
                whole += 1
            except LinkError as error:
                written = error.written
    # As in another process: only the file is left.
    monkeypatch.setattr(port_memory, "_here", {})
    received = pty.drain()
    with MyCobot280(pty.url) as arm:
        arm.stop()
    assert frames(received + pty.drain()) == [MOTION] * whole + [STOP]
    pty.close()


def test_late_reply_is_expected_on_a_link_whose_device_has_another_name_by_now(
    tmp_path: Path,
) -> None:
    link = tmp_path / "by-id"
    with ScriptedPeer() as before, ScriptedPeer() as after:
        link.symlink_to(before.url)
        with MyCobot(str(link), timeout=0.2) as arm, pytest.raises(ReplyTimeout):
            arm.get_encoder(1)
        link.unlink()
        link.symlink_to(after.url)
        started = time.monotonic()
        with MyCobot(str(link), timeout=0.2) as arm, pytest.raises(ReplyTimeout):
            arm.get_encoder(2)
        assert time.monotonic() - started > 0.8


def test_session_that_leaves_nothing_writes_no_file(folder: Path) -> None:
    with ScriptedPeer([bytes.fromhex("FE FE 03 12 01 FA")]) as peer, MyCobot(peer.url) as arm:
        assert arm.is_power_on()
    assert not folder.exists()


def _memory(peer: ScriptedPeer) -> PortMemory:
    transport = open_transport(peer.url, 115200)
    transport.close()
    return PortMemory(transport)


@pytest.fixture
def memory(monkeypatch: pytest.MonkeyPatch) -> Iterator[PortMemory]:
    monkeypatch.setattr(port_memory, "_here", {})
    with ScriptedPeer() as peer:
        yield _memory(peer)


def test_note_is_read_once(memory: PortMemory, folder: Path) -> None:
    until = time.monotonic() + 5
    note = Leftover((LateFrame(GET_ENCODER, until),), (Part(MOTION, 8),))
    memory.leave(note)
    port_memory._here.clear()
    assert memory.recall() == note
    assert memory.recall().empty
    assert not list(folder.iterdir())


@pytest.mark.parametrize("until", [-1.0, 1e9, float("nan"), float("inf")])
def test_note_of_another_time_expects_no_reply(memory: PortMemory, until: float) -> None:
    memory.leave(Leftover((LateFrame(GET_ENCODER, time.monotonic() + until),)))
    port_memory._here.clear()
    assert memory.recall().empty


DAMAGED = {
    "empty": "",
    "not JSON": "{",
    "deep": "[" * 60_000,
    "no object": "[]",
    "no port": "{}",
    "no list": '{"port": PORT, "late": 5, "parts": []}',
    "no hex": '{"port": PORT, "late": [["zz", 1.0]], "parts": []}',
    "no number": '{"port": PORT, "late": [["FEFE033B01FA", "x"]], "parts": []}',
    "whole part": '{"port": PORT, "late": [], "parts": [["FEFE033B01FA", 7]]}',
    "tiny frame": '{"port": PORT, "late": [], "parts": [["FE", 1]]}',
    "long number": '{"port": PORT, "late": [], "parts": [["FEFE033B01FA", 1' + "0" * 5000 + "]]}",
    "another port": '{"port": "other", "late": [], "parts": [["FEFE033B01FA", 2]]}',
}


@pytest.mark.parametrize("text", DAMAGED.values(), ids=DAMAGED.keys())
def test_damaged_note_is_no_note(memory: PortMemory, folder: Path, text: str) -> None:
    memory.leave(Leftover((), (Part(MOTION, 8),)))
    port_memory._here.clear()
    [path] = folder.iterdir()
    path.write_text(text.replace("PORT", json.dumps(memory._keys[0])))
    assert memory.recall().empty


def test_folder_that_others_can_write_is_not_used(memory: PortMemory, folder: Path) -> None:
    folder.mkdir()
    folder.chmod(0o777)
    memory.leave(Leftover((), (Part(MOTION, 8),)))
    assert not list(folder.iterdir())
    assert memory.recall().parts, "this process remembers"


def test_folder_is_in_the_temporary_folder(folder: Path, memory: PortMemory) -> None:
    memory.leave(Leftover((), (Part(MOTION, 8),)))
    assert folder.parent == Path(os.environ["TMPDIR"])
    assert folder.stat().st_mode & 0o777 == 0o700


def test_link_that_is_no_folder_is_not_followed(
    folder: Path, tmp_path: Path, memory: PortMemory
) -> None:
    (tmp_path / "elsewhere").mkdir()
    folder.symlink_to(tmp_path / "elsewhere")
    memory.leave(Leftover((), (Part(MOTION, 8),)))
    assert not list((tmp_path / "elsewhere").iterdir())
