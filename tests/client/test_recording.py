"""``record=`` of a client records its traffic, as ``--record`` of the command line does."""

from __future__ import annotations

import asyncio
import logging
import os
import resource
from pathlib import Path
from typing import Any

import pytest

from both_ways import Opener
from cobotwire import CaptureError, MyCobot280, UsageError, connect, connect_async
from cobotwire.capture import CaptureReader, Recording, read
from cobotwire.editions import mycobot280
from cobotwire.simulator import MemoryTransport, PtyServer, SimulatedArm
from scripted_peer import ScriptedPeer
from transport.ends import PtyEnd
from transport.test_forks import in_child

POWERED = bytes.fromhex("FE FE 03 12 01 FA")
QUERY = bytes.fromhex("FE FE 02 12 FA")


def recorded(path: Path) -> tuple[CaptureReader, list[tuple[str, bytes]]]:
    with read(path) as capture:
        return capture, [(packet.direction, packet.data) for packet in capture]


def test_exception_in_the_block_finishes_the_file(open_arm: Opener, tmp_path: Path) -> None:
    path = tmp_path / "run.pcapng"
    with ScriptedPeer() as peer:
        with pytest.raises(ZeroDivisionError), open_arm(peer.url, record=str(path)):
            raise ZeroDivisionError
        capture, packets = recorded(path)
        assert capture.finished
        assert packets == [("sent", bytes.fromhex("FE FE 02 29 FA"))], "stop is recorded"


def test_existing_file_is_refused_as_by_the_command_line(open_arm: Opener, tmp_path: Path) -> None:
    path = tmp_path / "run.pcapng"
    path.write_bytes(b"mine")
    with ScriptedPeer() as peer:
        with pytest.raises(UsageError) as by_client:
            open_arm(peer.url, record=path)
        with pytest.raises(UsageError) as by_command_line:
            Recording(path, None)
        assert str(by_client.value) == str(by_command_line.value)
        assert peer.received == b""
        # The port was closed, so it can be opened again.
        open_arm(peer.url).__exit__(None, None, None)
    assert path.read_bytes() == b"mine"


@pytest.mark.parametrize("failing", [False, True], ids=["normal end", "exception"])
def test_full_disk_stops_the_recording_and_not_the_arm(
    open_arm: Opener, tmp_path: Path, caplog: pytest.LogCaptureFixture, failing: bool
) -> None:
    path = tmp_path / "run.pcapng"
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    # Python ignores SIGXFSZ, so a write beyond this size fails as on a full disk.
    size = 400
    expected: Any = ZeroDivisionError if failing else CaptureError

    def use(url: str) -> None:
        with open_arm(url, record=path) as arm:
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
            try:
                replies = [arm.is_power_on() for _ in range(10)]
            finally:
                resource.setrlimit(resource.RLIMIT_FSIZE, limits)
            assert replies == [True] * 10
            assert caplog.text.count("run.pcapng stopped") == 1
            if failing:
                raise ZeroDivisionError

    with ScriptedPeer(*[[POWERED]] * 10) as peer, caplog.at_level(logging.ERROR):
        with pytest.raises(expected) as caught:
            use(peer.url)
        if failing:
            assert "the recording is incomplete" in caught.value.__notes__[0]
        open_arm(peer.url).__exit__(None, None, None)


def test_transport_of_the_users_own_is_recorded(tmp_path: Path) -> None:
    class Plain:
        """A transport with only the required members."""

        url = "plain"

        def __init__(self) -> None:
            inner = MemoryTransport(SimulatedArm(mycobot280.TABLE))
            self.write, self.read, self.close = inner.write, inner.read, inner.close

    for name, transport in (
        ("plain", Plain()),
        ("memory", MemoryTransport(SimulatedArm(mycobot280.TABLE))),
    ):
        path = tmp_path / name
        with MyCobot280(transport, record=path) as arm:
            arm.is_power_on()
        assert [way for way, _ in recorded(path)[1]] == ["sent", "received"]


@pytest.mark.parametrize("asynchronous", [False, True])
def test_connect_records_the_client_that_it_returns(tmp_path: Path, asynchronous: bool) -> None:
    path = tmp_path / "run.pcapng"

    def use(url: str) -> None:
        with connect(url, record=path, baudrate=1_000_000) as arm:
            arm.is_power_on()

    async def use_in_loop(url: str) -> None:
        async with await connect_async(url, record=path, baudrate=1_000_000) as arm:
            await arm.is_power_on()

    with PtyServer(SimulatedArm(mycobot280.TABLE)) as server:
        asyncio.run(use_in_loop(server.url)) if asynchronous else use(server.url)
        capture, packets = recorded(path)
        assert capture.interfaces == [(server.url, "mycobot280", 1_000_000)]
        assert packets[0] == ("sent", QUERY)
        assert len(packets) == 2


def test_forked_child_writes_nothing_into_the_recording(tmp_path: Path) -> None:
    path = tmp_path / "run.pcapng"
    end = PtyEnd()
    with MyCobot280(end.url, record=path) as arm:
        # Half a frame waits in the recorder, and must be written once.
        end.send(POWERED[:3])
        arm.listen(0.05)
        connection: Any = arm._connection
        recording = connection._port.recording
        size = os.path.getsize(path)

        def use_and_close() -> None:
            recording.record("received", POWERED * 2, 1.0)
            arm.close()
            recording.close()
            assert os.path.getsize(path) == size

        assert in_child(use_and_close) == ""
    capture, packets = recorded(path)
    assert capture.finished
    assert packets == [("received", POWERED[:3])]
    end.unplug()
