"""Run ``cobotwire tap`` between programs and a simulated arm on a pty, and end it in each way."""

from __future__ import annotations

import json
import os
import resource
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from subprocess import Popen

import pytest

from cobotwire import MyCobot280
from cobotwire.capture import Recording, read
from cobotwire.capture.packet import Interface
from cobotwire.codec import load
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.inspect.tap.copies import Copies, Copy
from cobotwire.inspect.tap.watching import Watching
from cobotwire.protocol.errors import CaptureError, LinkError
from cobotwire.simulator import PtyServer, SimulatedArm
from cobotwire.studio.live import LiveSession
from cobotwire.studio.serving import Options, staged
from command_line import printed, started
from in_process import cobotwire
from pymycobot_classes import library
from terminal import Terminal

REPLY = bytes.fromhex("FE FE 03 12 01 FA")


@pytest.fixture
def served() -> Iterator[PtyServer]:
    with PtyServer(SimulatedArm(TABLE, powered=True)) as server:
        yield server


def errors(tap: Popen[str]) -> str:
    assert tap.stderr is not None
    return tap.stderr.read()


def watching_process(tap: Popen[str]) -> int:
    return int(Path(f"/proc/{tap.pid}/task/{tap.pid}/children").read_text().split()[0])


@contextmanager
def calling(url: str) -> Iterator[MyCobot280]:
    """Let a program read joints all the time."""
    ended = threading.Event()

    def run() -> None:
        # The loop ends with the tap or the test.
        with suppress(LinkError):
            while not ended.wait(0.02):
                arm.get_angles()

    with MyCobot280(url, timeout=5.0) as arm:
        thread = threading.Thread(target=run)
        thread.start()
        try:
            yield arm
        finally:
            ended.set()
            thread.join()


def test_pymycobot_moves_the_arm_through_a_tap_that_ctrl_c_ends(
    served: PtyServer, tmp_path: Path
) -> None:
    path = tmp_path / "tap.pcapng"
    words = ["tap", served.url, "--record", str(path), "--only", "motion"]
    with Terminal(*words, columns=80, lines=24) as tap:
        tap.until(lambda: "towatchit" in tap.text())
        theirs = library("MyCobot280")(tap.rows()[0], 115200)
        assert theirs.send_angles([20, 0, 0, 0, 0, 0], 100) == 1
        assert len(theirs.get_angles()) == 6
        theirs._serial_port.close()
        tap.until(lambda: "closedtheport" in tap.text())
        # The terminal sends the signal to both processes.
        tap.press(b"\x03")
        assert tap.finish() == 0
        shown = tap.text()
    assert "send_angles(angles=(20,0,0,0,0,0" in shown
    assert "FEFE0220FA" not in shown
    assert f"wrote{path}" in shown
    with read(path) as capture:
        packets = list(capture)
        assert capture.finished
    assert capture.interfaces[0] == Interface(served.url, "mycobot280", 115200)
    requests = [packet.data[3] for packet in packets if packet.direction == "sent"]
    assert requests == [0x22, 0x20]


def test_monitor_and_studio_watch_a_tap_and_send_nothing(served: PtyServer, tmp_path: Path) -> None:
    path = tmp_path / "tap.pcapng"
    with started("tap", served.url, "--quiet", "--record", path) as tap:
        url = printed(tap).strip()
        source = printed(tap).split()[-1]
        assert source == f"follow:{path}"
        with calling(url):
            result = cobotwire("monitor", source, "--json", "--rate", "10", "--count", "5")
            sample = json.loads(result.stdout.splitlines()[-1])
            assert sample["values"]["get_angles"]["j1"] == 0
            # The program does not query the coordinates, and the monitor sends nothing itself.
            assert sample["values"]["get_coords"] is None
            assert sample["rate"] > 5
            assert sample["unanswered"] <= 1
            with staged(Options(source, "mycobot")) as stage:
                session = stage.session
                assert isinstance(session, LiveSession)
                assert stage.table.edition == "mycobot280"
                until = time.monotonic() + 10
                while session.history.count < 10 and time.monotonic() < until:
                    session.pass_on()
                    time.sleep(0.02)
                kinds = {(e.direction, e.data[3]) for e in session.entries()}
                assert kinds == {("sent", 0x20), ("received", 0x20)}
                with pytest.raises(Exception, match="this page only shows a recording"):
                    stage._line()
                assert session.state()["port"] == {"url": served.url, "problem": ""}
                tap.terminate()
                assert tap.wait(10) == 143
                until = time.monotonic() + 10
                while not session.line.problem and time.monotonic() < until:
                    time.sleep(0.02)
                assert session.line.problem == "the recording has ended"
                with pytest.raises(LinkError):
                    MyCobot280(url)


def test_read_only_tap_refuses_motion_and_ends_when_the_arm_is_unplugged() -> None:
    served = PtyServer(SimulatedArm(TABLE, powered=True))
    served.__enter__()
    with started("tap", served.url, "--read-only", "--json") as tap:
        first = json.loads(printed(tap))
        assert first["event"] == "serving"
        with MyCobot280(first["url"], timeout=5.0, on_error="leave") as arm:
            arm.send_angle(1, 50, 100)
            arm.stop()
            assert arm.get_angles().j1 == 0
            seen = [json.loads(printed(tap)) for _ in range(6)]
            served.__exit__()
            assert tap.wait(10) == 3
            with pytest.raises(LinkError):
                arm.get_angles()
        assert "cannot be read" in errors(tap)
    events = [(each["event"], each.get("meaning", "").partition("(")[0]) for each in seen]
    assert ("held back", "send_angle") in events
    assert ("passed", "stop") in events
    assert not any("-> send_angle" in meaning for _, meaning in events)


def test_stopped_watching_process_delays_nobody_and_a_full_disk_only_ends_the_recording(
    served: PtyServer, tmp_path: Path
) -> None:
    path = tmp_path / "tap.pcapng"
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, before[1]))
    with started("tap", served.url, "--record", path, "--quiet") as tap:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        url = printed(tap).strip()
        os.kill(watching_process(tap), signal.SIGSTOP)
        with MyCobot280(url, timeout=5.0) as arm:
            for _ in range(100):
                assert arm.get_angles().j1 == 0
            os.kill(watching_process(tap), signal.SIGCONT)
            # The disk is full after some 30 calls.
            for _ in range(10):
                assert arm.get_angles().j1 == 0
        tap.send_signal(signal.SIGINT)
        assert tap.wait(10) == 6
        assert "the recording is incomplete: [Errno 27] File too large" in errors(tap)
        assert tap.stdout is not None
        assert "the recording ends here: [Errno 27] File too large" in tap.stdout.read()


def test_recording_that_exists_ends_the_tap_before_a_program_can_connect(
    served: PtyServer, tmp_path: Path
) -> None:
    path = tmp_path / "tap.pcapng"
    path.write_text("kept")
    with started("tap", served.url, "--record", path) as tap:
        assert tap.wait(10) == 2
        assert printed(tap) == ""
        assert "exists already" in errors(tap)
    assert path.read_text() == "kept"


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (["--only", "dance"], "only is 'dance'; allowed: a command of mycobot280, or motion, "),
        (["--tcp", "host"], "address is 'host'; allowed: HOST:PORT"),
    ],
)
def test_wrong_option_is_reported_and_nothing_is_opened(
    served: PtyServer, words: list[str], error: str
) -> None:
    result = cobotwire("tap", served.url, *words)
    assert result.returncode == 2
    assert error in result.stderr


def test_lost_copies_are_counted_and_the_recording_is_not_marked_as_finished(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    niced = list[int]()
    # A process cannot raise its priority again: all later tests would be slow.
    monkeypatch.setattr("os.nice", niced.append)
    path, codec = tmp_path / "tap.pcapng", load(TABLE)
    reading, writing = os.pipe()
    copies, others = Copies(writing), list[Copy]()
    copies._dropped = 7
    copies.put("received", REPLY, time.monotonic())
    copies.close()
    watching = Watching(reading, codec, Recording(path, codec), lambda packet: None, others.append)
    with pytest.raises(CaptureError, match="incomplete: 7 bytes came too fast"):
        watching.run(lambda: None)
    os.close(reading)
    assert niced == [10]
    assert [other.data for other in others] == [b"7"]
    with read(path) as capture:
        assert [packet.data for packet in capture] == [REPLY]
        assert not capture.finished
