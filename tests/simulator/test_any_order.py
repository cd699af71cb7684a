"""Check the laws of the arm for legal commands in any order, at any times."""

from __future__ import annotations

import random
from typing import Any

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    invariant,
    rule,
    run_state_machine_as_test,
)

import strategies
from cobotwire import codec as codecs
from cobotwire.editions import mycobot, mycobot280
from cobotwire.protocol.table import Command, Table
from cobotwire.session import text
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from kinematic_samples import random_angles

# Motion commands that set no joint in motion after a stop.
MOVES_NO_JOINT = {"pause", "resume", "clear_queue", "jog_stop", "set_gripper_state"}
CALIBRATIONS = {"set_servo_calibration"}
FASTEST, ACCELERATION, TICK = 150.0, 200.0, 360 / 4096
ROUNDING = 1e-6


class AnyOrder(RuleBasedStateMachine):
    """An arm, and what a client may expect of its motion.

    test_behaviours.py and the conformance of every edition check that settings are read back.
    """

    table: Table

    def __init__(self) -> None:
        super().__init__()
        self.clock = SteppedClock(1000.0)
        self.arm = SimulatedArm(self.table, clock=self.clock)
        self.reference = codecs.load(self.table, "reference")
        self.stopped_at: float | None = None
        self.stood: tuple[float, ...] | None = None
        self.seen = (self.clock(), self.arm.state.angles.position(self.clock()))
        self.excused = [(0.0, 0.0)] * self.table.joints

    # Actions of a client.

    @initialize()
    def power(self) -> None:
        self.send("power_on")

    @rule(data=st.data())
    def any_command(self, data: st.DataObject) -> None:
        variant = data.draw(st.sampled_from(REQUESTS[self.table.edition]))
        self.send(variant.command.name, *data.draw(strategies.legal_values(variant.variant)))

    @rule(data=st.data())
    def any_motion(self, data: st.DataObject) -> None:
        moving = [
            variant
            for variant in REQUESTS[self.table.edition]
            if variant.command.safety == "motion" or variant.command.role
        ]
        variant = data.draw(st.sampled_from(moving))
        self.send(variant.command.name, *data.draw(strategies.legal_values(variant.variant)))

    @rule(rng=st.randoms(use_true_random=False), speed=st.integers(1, 100), mode=st.integers(0, 1))
    def move_to_a_reachable_pose(self, rng: random.Random, speed: int, mode: int) -> None:
        state = self.arm.state
        end = state.reported_coords(tuple(a / 3 for a in random_angles(rng)))
        numbers = self.table.in_role("coordinate targets").request[0].fields[0].cases[0].numbers
        if end and all(n.minimum <= v * n.divide <= n.maximum for n, v in zip(numbers, end)):
            self.send("send_coords", end, speed, mode)

    @rule(seconds=st.sampled_from([0.0, 0.01, 0.1, 0.5, 1.0, 3.0, 60.0]))
    def time_goes_by(self, seconds: float) -> None:
        self.clock.sleep(seconds)

    @rule()
    def wake(self) -> None:
        self.send("resume")
        self.send("power_on")

    @rule(rng=st.randoms(use_true_random=False), seconds=st.sampled_from([0.0, 0.3, 5.0]))
    def stop_and_move_again(self, rng: random.Random, seconds: float) -> None:
        self.send("send_angles", tuple(angle / 2 for angle in random_angles(rng)), 50)
        self.clock.sleep(seconds)
        self.joints_stay_within_limits_and_below_the_fastest_speed()
        self.send(self.table.in_role("stop").name)
        self.clock.sleep(FASTEST / ACCELERATION)
        self.no_joint_moves_after_a_stop()
        self.send("resume")
        self.no_joint_moves_after_a_stop()
        target, notes = tuple(angle / 2 for angle in random_angles(rng)), len(self.arm.notes)
        self.send("send_angles", target, 50)
        self.clock.sleep(0.5)
        if len(self.arm.notes) == notes:
            aim = self.arm.state.angles.target(self.clock())
            assert all(abs(a - b) <= TICK for a, b in zip(aim, target)), "the motion is obeyed"

    @rule(data=st.data())
    def shift_coordinates_by_any_reference(self, data: st.DataObject) -> None:
        for name in ("set_world_reference", "set_tool_reference"):
            [variant] = self.table.command(name).request
            self.send(name, *data.draw(strategies.legal_values(variant)))
        self.send("set_reference_frame", 1)
        self.send("set_end_type", 1)
        self.send("get_coords")

    # Laws.

    @invariant()
    def joints_stay_within_limits_and_below_the_fastest_speed(self) -> None:
        before, seen = self.seen
        now, state = self.clock(), self.arm.state
        position, stop = state.angles.position(now), state.angles.stop_at(now)
        self.seen = now, position
        most = FASTEST * (now - before) + ROUNDING
        pairs = zip(position, state.minimum, state.maximum)
        for joint, (angle, low, high) in enumerate(pairs):
            least, greatest = self.excused[joint]
            assert min(low, least) - ROUNDING <= angle <= max(high, greatest) + ROUNDING
            assert abs(angle - seen[joint]) <= most, "no joint jumps"
            # A joint that is still inside may be about to brake beyond a new limit.
            if low <= angle <= high and low <= stop[joint] <= high:
                self.excused[joint] = (low, high)

    @invariant()
    def no_joint_moves_after_a_stop(self) -> None:
        if self.stopped_at is None or self.clock() < self.stopped_at + FASTEST / ACCELERATION:
            return
        position = self.arm.state.standing(self.clock())
        self.stood = self.stood or position
        assert position == self.stood
        assert not self.arm.state.angles.moving(self.clock())

    @invariant()
    def reported_angles_are_the_actual_angles(self) -> None:
        angles = self.reference.decode("reply", self.reply_to("get_angles")).values[0]
        exact = self.arm.state.angles.position(self.clock())
        assert all(abs(a - b) <= TICK / 2 + 0.01 for a, b in zip(angles, exact))

    @invariant()
    def time_goes_forward(self) -> None:
        times = [note.time for note in self.arm.notes]
        assert times == sorted(times)
        assert all(time <= self.clock() for time in times)

    # Helpers.

    def send(self, name: str, *values: Any) -> None:
        """Send a request, and check its reply against the table."""
        self.expect_legal(self.table.command(name), self.reply_to(name, *values))
        self.note_motion(name)

    def reply_to(self, name: str, *values: Any) -> bytes:
        return self.arm.receive(self.reference.encode(name, "request", values))

    def expect_legal(self, command: Command, reply: bytes) -> None:
        if command.text is not None:
            assert text.decode(command.text, reply)
        elif command.reply:
            assert self.reference.decode("reply", reply, of=command.name).command is command
        else:
            assert reply == b""

    def note_motion(self, name: str) -> None:
        role, safety = self.table.command(name).role, self.table.command(name).safety
        if role == "stop":
            self.stopped_at, self.stood = self.clock(), None
        elif safety == "motion" and name not in MOVES_NO_JOINT:
            self.stopped_at = None
        if name in CALIBRATIONS:
            self.stood = None
            self.seen = (self.clock(), self.arm.state.angles.position(self.clock()))
        if name in CALIBRATIONS or name.startswith("set_joint_m"):
            # A joint may be outside limits that were set later, and brakes beyond them.
            state, now = self.arm.state, self.clock()
            ends = zip(state.angles.position(now), state.angles.stop_at(now))
            self.excused = [(min(pair), max(pair)) for pair in ends]


TABLES = {table.edition: table for table in (mycobot.TABLE, mycobot280.TABLE)}
REQUESTS = {
    edition: [
        variant for variant in strategies.variants_of(table) if variant.direction == "request"
    ]
    for edition, table in TABLES.items()
}


@pytest.mark.parametrize("edition", TABLES)
def test_laws_hold_for_commands_in_any_order(edition: str) -> None:
    machine = type("Machine", (AnyOrder,), {"table": TABLES[edition]})
    run_state_machine_as_test(
        machine, settings=settings(settings.default, max_examples=20, stateful_step_count=30)
    )
