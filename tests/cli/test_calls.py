"""Run motions with ``cobotwire call``, and check its report on requests without a reply."""

from __future__ import annotations

import json
import signal
import time
from pathlib import Path

import pytest

from cobotwire.capture import read
from cobotwire.editions import mycobot280
from cobotwire.simulator import PtyServer, RunningClock, SimulatedArm
from command_line import started
from in_process import cobotwire
from scripted_peer import ScriptedPeer

STOP = bytes.fromhex("FE FE 02 29 FA")


@pytest.fixture
def simulated() -> SimulatedArm:
    return SimulatedArm(mycobot280.TABLE, clock=RunningClock(), powered=True)


def test_motion_waits_and_prints_where_the_arm_is(server: PtyServer) -> None:
    words = "move_angles 1 2 3 4 5 6 100 timeout=9"
    moved = cobotwire("call", server.url, *words.split())
    assert (moved.returncode, moved.stderr.startswith("arrived after ")) == (0, True)
    assert "j1=0.96  j2=2.02" in moved.stdout
    homed = json.loads(cobotwire("call", server.url, "go_home", "--json").stdout)
    # An encoder counts in steps of 0.09 degrees.
    assert max(map(abs, homed["result"].values())) < 0.1
    assert 0 < homed["seconds"] < 9


def test_no_stop_is_sent_if_the_motion_was_not_sent(
    server: PtyServer, simulated: SimulatedArm
) -> None:
    simulated.state.paused = True
    refused = cobotwire("call", server.url, "go_home")
    assert (refused.returncode, simulated.state.paused) == (7, True)
    assert "go_home was not sent: the arm's motion is paused" in refused.stderr
    late = cobotwire("call", server.url, "move_angles", "9,0,0,0,0,0", "1", "timeout=.1", "--force")
    assert (late.returncode, "stop was sent" in late.stderr) == (7, True)


@pytest.mark.parametrize("words", ["move_angles 0,0,0,0,0,900 30", "go_home 101", "go_home x=1"])
def test_wrong_argument_of_a_motion_is_reported_before_a_byte_is_sent(words: str) -> None:
    with ScriptedPeer() as peer:
        assert cobotwire("call", peer.url, *words.split()).returncode == 2
        assert peer.received == b""


HANGUP = pytest.param(
    signal.SIGHUP,
    129,
    marks=pytest.mark.skipif(
        signal.getsignal(signal.SIGHUP) == signal.SIG_IGN, reason="nohup started the tests"
    ),
)


@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 143), HANGUP])
def test_signal_stops_a_motion_and_finishes_its_recording(
    server: PtyServer, simulated: SimulatedArm, tmp_path: Path, number: signal.Signals, code: int
) -> None:
    path = tmp_path / "arm.pcapng"
    with started("call", server.url, "move_angles", "90,0,0,0,0,0", "1", "--record", path) as call:
        while not simulated.state.angles.target(0.0)[0]:
            assert call.poll() is None
            time.sleep(0.01)
        # timeout(1) sends it twice.
        call.send_signal(number)
        call.send_signal(number)
        assert call.wait(timeout=20) == code
    with read(path) as capture:
        assert STOP in [packet.data for packet in capture if packet.direction == "sent"]
        assert capture.finished


@pytest.mark.parametrize(("acks", "says"), [(True, "after "), (False, "within 100 ms")])
def test_setter_says_whether_it_was_acknowledged(acks: bool, says: str) -> None:
    with PtyServer(SimulatedArm(mycobot280.TABLE, acks=acks)) as server:
        call = ("call", server.url, "set_color", "1", "2", "3", "--timeout", "0.1")
        text, machine = cobotwire(*call), cobotwire(*call, "--json")
    assert (text.returncode, text.stdout) == (0, "")
    assert says in text.stderr
    assert (json.loads(machine.stdout)["acknowledged"], machine.stderr) == (acks, "")
