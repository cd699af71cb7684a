"""The next session on a port, in any process, respects the persisted state of the last one."""

from __future__ import annotations

import asyncio
import gc
import json
import os
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from both_ways import InLoop
from cobotwire import LinkError, MyCobot, ReplyTimeout
from cobotwire.client import persisted_state, port_notes
from cobotwire.client.persisted_state import PersistedSession
from cobotwire.client.port_notes import LONGEST
from cobotwire.editions.mycobot import AsyncMyCobot
from cobotwire.editions.mycobot280 import MyCobot280
from cobotwire.session import Exchange
from cobotwire.session.alignment import Part
from cobotwire.session.outstanding import LateFrame, PersistedState
from cobotwire.simulator.faults import Late
from cobotwire.transport import open_transport
from cut_motion import ANGLES, CODEC, MOTION, STOP, frames
from faulty_arm import faulty_arm
from scripted_peer import ScriptedPeer
from transport.ends import PtyEnd

LATE = 0.75
# The attempts of the first query.
ATTEMPTS = (1, 2, 3)
GET_ENCODER = bytes.fromhex("FE FE 03 3B 01 FA")
BOTH = [MyCobot, lambda port, **options: InLoop(AsyncMyCobot, port, **options)]


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder of the notes, which other tests do not use."""
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    return tmp_path / f"cobotwire-{os.getuid()}"


@pytest.mark.parametrize("who", BOTH)
def test_late_reply_to_a_closed_client_is_not_used_by_the_next_one(who: Callable[..., Any]) -> None:
    with faulty_arm(Late(seconds=LATE, nth=ATTEMPTS)) as (url, _):
        with who(url, timeout=0.3) as arm, pytest.raises(ReplyTimeout):
            arm.get_encoder(1)
        with who(url) as arm:
            assert arm.get_encoder(2) == 2


def _drop(url: str) -> None:
    arm = MyCobot(url, timeout=0.1)
    with pytest.raises(ReplyTimeout):
        arm.get_encoder(1)


async def _drop_async(url: str) -> None:
    arm = AsyncMyCobot(url, timeout=0.1)
    await arm.open()
    with pytest.raises(ReplyTimeout):
        await arm.get_encoder(1)


@pytest.mark.parametrize("drop", [_drop, lambda url: asyncio.run(_drop_async(url))])
@pytest.mark.filterwarnings("ignore::ResourceWarning")
def test_late_reply_to_a_dropped_client_is_not_used_by_the_next_one(
    drop: Callable[[str], None],
) -> None:
    with faulty_arm(Late(seconds=LATE)) as (url, _):
        drop(url)
        gc.collect()
        with MyCobot(url, timeout=3) as arm:
            assert arm.get_encoder(2) == 2


NEVER_CLOSED = """
import sys
from cobotwire import MyCobot, ReplyTimeout, RetryPolicy
arm = MyCobot(sys.argv[1], timeout=0.01, retry=RetryPolicy(1, grace=60))
try:
    arm.get_encoder(1)
except ReplyTimeout:
    pass
"""


def test_process_that_never_closes_its_client_leaves_a_note_on_its_port() -> None:
    with ScriptedPeer() as peer:
        subprocess.run([sys.executable, "-c", NEVER_CLOSED, peer.url], check=True)
        assert [late.request for late in _memory(peer).recall().late] == [GET_ENCODER]


def test_closed_client_leaves_its_note_once() -> None:
    with ScriptedPeer() as peer:
        arm = MyCobot(peer.url, timeout=0.01)
        with pytest.raises(ReplyTimeout):
            arm.get_encoder(1)
        arm.close()
        memory = _memory(peer)
        assert memory.recall().late
        arm.close()
        del arm
        gc.collect()
        assert memory.recall().empty


def test_half_a_request_of_a_closed_client_is_ended_by_the_next_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pty, whole, written = PtyEnd(), 0, None
    with MyCobot280(pty.url) as arm:
        while written is None:
            try:
                arm.send_angles(ANGLES, 50)
                whole += 1
            except LinkError as error:
                written = error.written
    # As in another process: only the file is left.
    monkeypatch.setattr(persisted_state, "_here", {})
    received = pty.drain()
    with MyCobot280(pty.url) as arm:
        arm.stop()
    assert frames(received + pty.drain()) == [MOTION] * whole + [STOP]
    pty.unplug()


def test_late_reply_is_expected_on_a_link_after_its_device_was_renamed(
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


def _memory(peer: ScriptedPeer) -> PersistedSession:
    transport = open_transport(peer.url, 115200)
    transport.close()
    return PersistedSession(transport)


@pytest.fixture
def memory(monkeypatch: pytest.MonkeyPatch) -> Iterator[PersistedSession]:
    monkeypatch.setattr(persisted_state, "_here", {})
    with ScriptedPeer() as peer:
        yield _memory(peer)


def test_note_is_read_once(memory: PersistedSession, folder: Path) -> None:
    until = time.monotonic() + 5
    note = PersistedState((LateFrame(GET_ENCODER, until),), (Part(MOTION, 8),))
    memory.leave(note)
    persisted_state._here.clear()
    assert memory.recall() == note
    assert memory.recall().empty
    assert not list(folder.iterdir())


@pytest.mark.parametrize("until", [-1.0, 1e9, float("nan"), float("inf")])
def test_note_of_another_time_expects_no_reply(memory: PersistedSession, until: float) -> None:
    memory.leave(PersistedState((LateFrame(GET_ENCODER, time.monotonic() + until),)))
    persisted_state._here.clear()
    assert memory.recall().empty


@pytest.mark.parametrize("boot", ["another", "", 5])
def test_note_of_another_boot_expects_no_reply(
    memory: PersistedSession, folder: Path, monkeypatch: pytest.MonkeyPatch, boot: object
) -> None:
    this_boot = folder.parent / "boot_id"
    this_boot.write_text("this\n")
    monkeypatch.setattr(port_notes, "BOOT_ID", str(this_boot))
    # The monotonic clock of this boot is ahead of the other boot's clock.
    _damage(memory, folder, boot=boot)
    assert memory.recall() == PersistedState((), (Part(MOTION, 8),)), "the arm may hold the part"


@pytest.mark.parametrize("passed", [0.0, 5.0, 20.0])
def test_note_without_a_boot_id_expires_by_the_clock_that_has_advanced_further(
    memory: PersistedSession, folder: Path, monkeypatch: pytest.MonkeyPatch, passed: float
) -> None:
    monkeypatch.setattr(port_notes, "BOOT_ID", "/nope")
    _damage(memory, folder, clocks=[time.monotonic(), time.time() - passed])
    late = [late.until - time.monotonic() for late in memory.recall().late]
    assert late == ([pytest.approx(10 - passed, abs=1)] if passed < 10 else [])


def test_clock_that_shows_less_than_the_note_is_of_another_boot(
    memory: PersistedSession, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(port_notes, "BOOT_ID", "/nope")
    later = time.monotonic() + 1000
    _damage(memory, folder, clocks=[later, time.time()], late=[[GET_ENCODER.hex(), later + 1]])
    assert not memory.recall().late


def _damage(memory: PersistedSession, folder: Path, **values: object) -> None:
    """Leave a note, and replace these values in it."""
    until = time.monotonic() + 10
    memory.leave(PersistedState((LateFrame(GET_ENCODER, until),), (Part(MOTION, 8),)))
    persisted_state._here.clear()
    [path] = folder.iterdir()
    path.write_text(json.dumps(json.loads(path.read_text()) | values))


ANY_JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.just(10**400)
    | st.floats()
    | st.text(max_size=8)
    | st.sampled_from([GET_ENCODER.hex(), "FE", "FEFE"]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=6,
)
FRAMES = st.sampled_from([GET_ENCODER, MOTION, b"\xfe\xfe\x1a"]).map(bytes.hex) | st.binary(
    max_size=8
).map(bytes.hex)
NUMBERS = st.floats() | st.integers() | st.just(10**400)
# For each key of a note: sometimes a value of the right type, sometimes any JSON.
VALUES = {
    "port": ANY_JSON,
    "boot": ANY_JSON,
    "clocks": st.lists(NUMBERS, min_size=1, max_size=3) | ANY_JSON,
    "late": st.lists(st.tuples(FRAMES, NUMBERS), max_size=3) | ANY_JSON,
    "parts": st.lists(st.tuples(FRAMES, st.integers(1, 9) | NUMBERS), max_size=3) | ANY_JSON,
}


@given(
    st.binary(max_size=60)
    | st.sampled_from([b"", b"{", b"[" * 60_000, b"\xff\xfe{", bytes(70_000), b"1" * 5000])
    | ANY_JSON.map(lambda value: json.dumps(value).encode())
    | st.fixed_dictionaries({}, optional=VALUES)
)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_port_with_any_note_is_opened_and_no_request_is_held_longer_than_the_grace(
    memory: PersistedSession,
    folder: Path,
    caplog: pytest.LogCaptureFixture,
    content: bytes | dict[str, Any],
) -> None:
    caplog.clear()
    memory.leave(
        PersistedState((LateFrame(GET_ENCODER, time.monotonic() + 5),), (Part(MOTION, 8),))
    )
    persisted_state._here.clear()
    [path] = folder.iterdir()
    if isinstance(content, bytes):
        path.write_bytes(content)
    else:
        path.write_text(json.dumps(json.loads(path.read_text()) | content))
    found = memory.recall()
    assert all(late.until <= time.monotonic() + LONGEST for late in found.late)
    assert bool(caplog.records) <= found.empty, "what is used needs no warning"
    assert bool(caplog.records) or isinstance(content, dict), "only an object needs no warning"
    assert not list(folder.iterdir())
    exchange = Exchange(CODEC)
    exchange.restore(found)
    assert exchange.persist(0.0).parts == found.parts


@pytest.mark.parametrize("kind", ["fifo", "link", "folder", "socket", "of another user"])
def test_file_of_another_kind_at_the_path_of_a_note_is_not_read(
    memory: PersistedSession,
    folder: Path,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
    kind: str,
) -> None:
    memory.leave(PersistedState((), (Part(MOTION, 8),)))
    persisted_state._here.clear()
    [path] = folder.iterdir()
    note = path.rename(folder.parent / "note")
    if kind == "fifo":
        os.mkfifo(path)
    elif kind == "link":
        path.symlink_to(note)
    elif kind == "folder":
        path.mkdir()
    elif kind == "socket":
        with socket.socket(socket.AF_UNIX) as bound:
            bound.bind(str(path))
    else:
        note.rename(path)
        mine = os.fstat
        monkeypatch.setattr(os, "fstat", lambda file: _of_another_user(mine(file)))
    assert memory.recall().empty
    assert [record.levelname for record in caplog.records] == ["WARNING"]
    assert str(path) in caplog.text


def _of_another_user(found: os.stat_result) -> os.stat_result:
    return os.stat_result((*found[:4], found.st_uid + 1, *found[5:]))


def test_folder_that_others_can_write_is_not_used(memory: PersistedSession, folder: Path) -> None:
    folder.mkdir()
    folder.chmod(0o777)
    memory.leave(PersistedState((), (Part(MOTION, 8),)))
    assert not list(folder.iterdir())
    assert memory.recall().parts, "this process remembers"


def test_folder_is_in_the_temporary_folder(folder: Path, memory: PersistedSession) -> None:
    memory.leave(PersistedState((), (Part(MOTION, 8),)))
    assert folder.parent == Path(os.environ["TMPDIR"])
    assert folder.stat().st_mode & 0o777 == 0o700


def test_link_that_is_no_folder_is_not_followed(
    folder: Path, tmp_path: Path, memory: PersistedSession
) -> None:
    (tmp_path / "elsewhere").mkdir()
    folder.symlink_to(tmp_path / "elsewhere")
    memory.leave(PersistedState((), (Part(MOTION, 8),)))
    assert not list((tmp_path / "elsewhere").iterdir())
