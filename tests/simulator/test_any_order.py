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
    precondition,
    rule,
    run_state_machine_as_test,
)

import strategies
from cobotwire import codec as codecs
from cobotwire.editions import mycobot, mycobot280
from cobotwire.protocol.table import Command, Table, Variant
from cobotwire.session import text
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from kinematic_samples import random_angles

# A getter has the name of its setter, except for the first word; these are exceptions.
READ_BY = {
    "set_digital_output": "get_digital_input",
    "set_basic_output": "get_basic_input",
    "set_joint_min": "get_joint_min_angle",
    "set_joint_max": "get_joint_max_angle",
}
# Other commands that change a setting: power_on ends free mode, a backup restores registers.
CHANGES = {
    "power_on": {"is_free_mode"},
    "restore_servo_params": {"get_servo_data"},
}
# Motion commands that set no joint in motion after a stop.
MOVES_NO_JOINT = {"pause", "resume", "clear_queue", "jog_stop", "set_gripper_state"}
CALIBRATIONS = {"set_servo_calibration"}
FASTEST, ACCELERATION, TICK = 150.0, 200.0, 360 / 4096
ROUNDING = 1e-6


def getter_of(table: Table, setter: str) -> Command | None:
    """Return the command that reads a setting back in a frame; None if no command does."""
    what = setter.removeprefix("set_")
    wanted = READ_BY.get(setter), f"get_{what}", f"is_{what}"
    if not setter.startswith("set_") or table.command(setter).safety == "motion":
        return None
    return next(
        (one for one in table.commands if one.name in wanted and one.text is None),
        None,
    )


class AnyOrder(RuleBasedStateMachine):
    """An arm, and the state that a client may expect from it."""

    table: Table
    codec_name: codecs.CodecName

    def __init__(self) -> None:
        super().__init__()
        self.clock = SteppedClock(1000.0)
        self.arm = SimulatedArm(self.table, clock=self.clock, codec=self.codec_name)
        self.reference = codecs.load(self.table, "reference")
        self.set: dict[tuple[str, tuple[Any, ...]], dict[str, Any]] = {}
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

    @precondition(lambda self: self.set)
    @rule(data=st.data())
    def setting_is_read_back(self, data: st.DataObject) -> None:
        self.recall(data.draw(st.sampled_from(sorted(self.set, key=repr))))

    @rule(account=st.text("ab c", min_size=1).filter(lambda name: name.strip() == name))
    def text_after_a_request_is_stored(self, account: str) -> None:
        for command in self.table.commands:
            if command.request_text is not None:
                given = dict.fromkeys(command.request_text.fields, account)
                self.send(command.name)
                assert self.arm.receive(text.encode(command.request_text, given)) == b""
                assert (self.arm.state.kept["ssid"], self.arm.state.kept["password"]) == (
                    account,
                    account,
                )

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
        """Send a request, check its reply against the table, and remember the setting."""
        reply = self.reply_to(name, *values)
        self.expect_legal(self.table.command(name), reply)
        request = self.reference.decode("request", self.frame(name, *values)).fields
        self.note_motion(name)
        for getter in CHANGES.get(name, ()):
            self.set = {key: value for key, value in self.set.items() if key[0] != getter}
        read_by = getter_of(self.table, name)
        if read_by is not None:
            self.remember(read_by, request)

    def frame(self, name: str, *values: Any) -> bytes:
        return self.reference.encode(name, "request", values)

    def reply_to(self, name: str, *values: Any) -> bytes:
        return self.arm.receive(self.frame(name, *values))

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

    def remember(self, getter: Command, request: dict[str, Any]) -> None:
        variant = _query_variant(getter, request)
        if variant is None:
            return
        arguments = tuple(request[field.name] for field in variant.fields)
        key = getter.name, arguments
        self.set = {old: value for old, value in self.set.items() if not _same(old, key)}
        self.set[key] = request
        self.recall(key)

    def recall(self, key: tuple[str, tuple[Any, ...]]) -> None:
        name, arguments = key
        reply = self.reference.decode("reply", self.reply_to(name, *arguments), of=name).fields
        given = self.set[key]
        for field, value in reply.items():
            if field in given and field not in ("joint", "pin"):
                expected = given[field]
                if name == "get_servo_data" and not given.get("mode"):
                    expected %= 256
                assert value == pytest.approx(expected, abs=0.051), name
        assert set(reply) & set(given), f"{name} reports something of the setting"


def _query_variant(getter: Command, request: dict[str, Any]) -> Variant | None:
    """Return the longest variant of the getter's request that the setter's arguments fill."""
    variants = [
        variant
        for variant in getter.request
        if {field.name for field in variant.fields} <= set(request)
    ]
    return max(variants, key=lambda variant: variant.size, default=None)


def _same(one: tuple[str, tuple[Any, ...]], two: tuple[str, tuple[Any, ...]]) -> bool:
    """Return whether two requests read the same setting; a mode after the register is ignored."""
    return (one[0], one[1][:2]) == (two[0], two[1][:2])


TABLES = {table.edition: table for table in (mycobot.TABLE, mycobot280.TABLE)}
REQUESTS = {
    edition: [
        variant for variant in strategies.variants_of(table) if variant.direction == "request"
    ]
    for edition, table in TABLES.items()
}


@pytest.mark.parametrize("codec_name", ["reference", "native"])
@pytest.mark.parametrize("edition", list(TABLES))
def test_laws_hold_for_commands_in_any_order(edition: str, codec_name: str) -> None:
    machine = type("Machine", (AnyOrder,), {"table": TABLES[edition], "codec_name": codec_name})
    run_state_machine_as_test(
        machine, settings=settings(settings.default, max_examples=EXAMPLES, stateful_step_count=30)
    )


EXAMPLES = 20


def test_every_setter_has_a_getter_in_the_laws() -> None:
    """List what the machine reads back, so that no new pair is forgotten."""
    found = {
        edition: {command.name for command in table.commands if getter_of(table, command.name)}
        for edition, table in TABLES.items()
    }
    assert len(found["mycobot"]) >= 11
    assert len(found["mycobot280"]) >= 15
