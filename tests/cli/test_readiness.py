"""Send motions to arms that are not ready for them; examine these arms with ``doctor``."""

from __future__ import annotations

import json
import time
from collections.abc import Callable

import pytest

from cobotwire.editions import mercury_a1, mycobot280, mycobot320
from cobotwire.simulator import PtyServer, SimulatedArm
from command_line import printed, started
from in_process import cobotwire
from scripted_peer import ScriptedPeer

MOTION = ("send_angles", "10,0,0,0,0,0", "30")
NO_POWER = "the arm has no power; cobotwire call {} power_on switches it on"
PAUSED = "the arm's motion is paused; cobotwire call {} resume continues the old motion at once"
ERROR = "the arm's error register is 3: joint 3 is beyond its limit; find the cause"


def _cut(arm: SimulatedArm) -> None:
    arm.state.powered = False


def _pause(arm: SimulatedArm) -> None:
    arm.state.paused = True


def _fail(arm: SimulatedArm) -> None:
    arm.state.error = 3


STATES = [
    pytest.param(_cut, "no-power", NO_POWER, id="no-power"),
    pytest.param(_pause, "paused", PAUSED, id="paused"),
    pytest.param(_fail, "error-register", ERROR, id="error"),
]


@pytest.mark.parametrize(("spoil", "kind", "text"), STATES)
def test_motion_to_an_arm_that_is_not_ready_is_not_sent_unless_forced(
    spoil: Callable[[SimulatedArm], None], kind: str, text: str
) -> None:
    arm = SimulatedArm(mycobot280.TABLE, powered=True)
    spoil(arm)
    with PtyServer(arm) as server:
        refused = cobotwire("call", server.url, *MOTION)
        target = arm.state.angles.target(0.0)
        forced = cobotwire("call", server.url, *MOTION, "--force")
    assert (refused.returncode, refused.stdout) == (7, "")
    assert refused.stderr.startswith(
        f"cobotwire: send_angles was not sent: {text.format(server.url)}"
    )
    assert len(refused.stderr.splitlines()) == 1
    assert target == (0, 0, 0, 0, 0, 0)
    assert (forced.returncode, forced.stderr.startswith("sent; acknowledged")) == (0, True)


def test_motion_without_arguments_is_checked_but_no_stop_is() -> None:
    arm = SimulatedArm(mycobot280.TABLE, powered=False)
    with PtyServer(arm) as server:
        assert cobotwire("call", server.url, "move_round").returncode == 7
    arm = SimulatedArm(mycobot320.TABLE, powered=False)
    with PtyServer(arm) as server:
        words = ("--edition", "mycobot320", "set_pro_gripper_stop", "14")
        done = cobotwire("call", server.url, *words)
    assert (done.returncode, "was not sent" in done.stderr) == (0, False)


def test_doctor_reports_why_an_arm_is_not_ready_for_motion() -> None:
    arm = SimulatedArm(mycobot280.TABLE, powered=True)
    for spoil in (_cut, _pause, _fail):
        spoil(arm)
    with PtyServer(arm) as server:
        human = cobotwire("doctor", server.url, "--count", "1")
        machine = cobotwire("doctor", server.url, "--count", "1", "--json")
    assert (human.returncode, machine.returncode) == (1, 1)
    assert "healthy" not in human.stdout
    report = json.loads(machine.stdout)
    assert not report["healthy"]
    found = [(each["kind"], each["text"]) for each in report["problems"] if each["serious"]]
    for (kind, sentence), state in zip(found, STATES, strict=True):
        _, expected, text = map(str, state.values)
        assert (kind, text.startswith(sentence[:40])) == (expected, True)
        assert f"! {kind}: {sentence}" in human.stdout
        assert text.partition("; ")[2].format(server.url) in human.stdout
    # The values begin in one column.
    assert "  get_error_information 3\n  is_moving             " in human.stdout


def test_coordinates_that_a_simulated_arm_cannot_compute_are_not_a_lost_reply() -> None:
    with PtyServer(SimulatedArm(mercury_a1.TABLE, powered=True)) as server:
        human = cobotwire("--edition", "mercury_a1", "doctor", server.url, "--count", "1")
    assert (human.returncode, human.stderr) == (0, "")
    assert (
        "- no-coordinates: no reply to get_coords; the edition has no geometry of" in human.stdout
    )
    assert human.stdout.endswith("healthy\n")


def test_doctor_names_the_command_that_switches_a_mercury_on() -> None:
    with PtyServer(SimulatedArm(mercury_a1.TABLE)) as server:
        human = cobotwire("--edition", "mercury_a1", "doctor", server.url, "--count", "1")
    assert human.returncode == 1
    assert f"cobotwire call {server.url} power_on switches it on" in human.stdout


def test_motion_is_not_sent_while_the_emergency_stop_is_pressed() -> None:
    state = bytes.fromhex("FE FE 04 12 02 9C F0")
    with ScriptedPeer([state], [state]) as peer:
        motion = ("call", peer.url, "send_angles", "10,0,0,0,0,0,0", "30", "--timeout", "0.1")
        result = cobotwire("--edition", "mercury_a1", *motion)
        received = peer.received
    assert result.returncode == 7
    assert "the arm has no power: it reports EMERGENCY_STOP; end that state first" in result.stderr
    assert bytes.fromhex("FE FE 12 22") not in received


def test_motion_that_the_arm_rejects_is_reported_after_it_was_sent() -> None:
    with PtyServer(SimulatedArm(mycobot280.TABLE, powered=True)) as server:
        result = cobotwire("call", server.url, "send_coords", "281,281,281,0,0,0", "30")
    assert result.returncode == 7
    reported = (
        "send_coords was sent, but the arm's error register is 32: the inverse kinematics has no"
    )
    assert reported in result.stderr


def test_commands_that_end_a_motion_are_sent_to_any_arm() -> None:
    arm = SimulatedArm(mycobot280.TABLE)
    arm.state.paused = True
    with PtyServer(arm) as server:
        for name in ("pause", "resume", "stop", "clear_queue", "power_on"):
            result = cobotwire("call", server.url, name)
            assert (result.returncode, result.stderr[:6]) == (0, "sent; "), name
        # Once a later query has its reply, the earlier one-way requests have arrived.
        assert cobotwire("call", server.url, "is_power_on").returncode == 0
    assert (arm.state.paused, arm.state.powered) == (False, True)


def test_motion_to_a_silent_arm_is_not_sent() -> None:
    with ScriptedPeer() as peer:
        result = cobotwire("call", peer.url, *MOTION, "--timeout", "0.1")
        received = peer.received
    assert result.returncode == 4
    assert "no reply to is_power_on" in result.stderr
    assert received.replace(bytes.fromhex("FE FE 02 12 FA"), b"") == b""


def test_missing_reply_to_a_state_query_does_not_prevent_a_motion() -> None:
    on = bytes.fromhex("FE FE 03 12 01 FA")
    motion = bytes.fromhex("FE FE 0F 22 03 E8 00 00 00 00 00 00 00 00 00 00 1E FA")
    with ScriptedPeer([on]) as peer:
        result = cobotwire("--edition", "mycobot", "call", peer.url, *MOTION, "--timeout", "0.1")
        until = time.monotonic() + 20
        while not peer.received.endswith(motion):
            assert time.monotonic() < until, peer.received
            time.sleep(0.01)
    sent = "sent; this request has no acknowledgement\n"
    assert (result.returncode, result.stderr) == (0, sent)


def test_simulated_arm_without_powered_refuses_the_motion_from_the_command_line() -> None:
    with started("sim", "--quiet") as sim:
        url = printed(sim).split()[-1]
        result = cobotwire("call", url, *MOTION)
        doctor = cobotwire("doctor", url, "--count", "1")
    assert (result.returncode, NO_POWER.format(url) in result.stderr) == (7, True)
    assert (doctor.returncode, "healthy" in doctor.stdout) == (1, False)
