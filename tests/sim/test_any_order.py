"""Whatever legal commands come in whatever order, with whatever time between, the laws hold."""

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
from cobotwire.session import text
from cobotwire.sim import SimulatedArm
from cobotwire.sim.clock import SteppedClock
from cobotwire.table import Command, Layout, Table
from kinematic_samples import random_angles

# The getter is called like its setter but for the first word; these are called otherwise.
READ_BY = {
    "set_digital_output": "get_digital_input",
    "set_basic_output": "get_basic_input",
    "set_joint_min": "get_joint_min_angle",
    "set_joint_max": "get_joint_max_angle",
}
# What else changes what was set: power ends free mode, a backup brings registers back.
CHANGES = {
    "power_on": {"is_free_mode"},
    "restore_servo_params": {"get_servo_data"},
}
CALIBRATIONS = {"set_servo_calibration"}
FASTEST, ACCELERATION, TICK = 150.0, 200.0, 360 / 4096
ROUNDING = 1e-6


def getter_of(table: Table, setter: str) -> Command | None:
    """The command that reads what ``setter`` sets at once, in a frame; None if nothing does."""
    what = setter.removeprefix("set_")
    wanted = READ_BY.get(setter), f"get_{what}", f"is_{what}"
    if not setter.startswith("set_") or table.command(setter).safety == "motion":
        return None
    return next(
        (one for one in table.commands if one.name in wanted and one.text is None),
        None,
    )


class AnyOrder(RuleBasedStateMachine):
    """An arm, and what a client may expect of it."""

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

    # What a client does.

    @initialize()
    def power(self) -> None:
        self.tell("power_on")

    @rule(data=st.data())
    def any_command(self, data: st.DataObject) -> None:
        form = data.draw(st.sampled_from(REQUESTS[self.table.edition]))
        self.tell(form.command.name, *data.draw(strategies.legal_values(form.layout)))

    @rule(data=st.data())
    def any_motion(self, data: st.DataObject) -> None:
        moving = [
            form
            for form in REQUESTS[self.table.edition]
            if form.command.safety == "motion" or form.command.role
        ]
        form = data.draw(st.sampled_from(moving))
        self.tell(form.command.name, *data.draw(strategies.legal_values(form.layout)))

    @rule(rng=st.randoms(use_true_random=False), speed=st.integers(1, 100), mode=st.integers(0, 1))
    def to_where_it_can_go(self, rng: random.Random, speed: int, mode: int) -> None:
        state = self.arm.state
        end = state.told_coords(tuple(a / 3 for a in random_angles(rng)))
        numbers = self.table.in_role("coordinate targets").request[0].fields[0].cases[0].numbers
        if end and all(n.minimum <= v * n.divide <= n.maximum for n, v in zip(numbers, end)):
            self.tell("send_coords", end, speed, mode)

    @rule(seconds=st.sampled_from([0.0, 0.01, 0.1, 0.5, 1.0, 3.0, 60.0]))
    def time_goes_by(self, seconds: float) -> None:
        self.clock.sleep(seconds)

    @rule()
    def wake(self) -> None:
        self.tell("resume")
        self.tell("power_on")

    @precondition(lambda self: self.set)
    @rule(data=st.data())
    def what_was_set_is_read_back(self, data: st.DataObject) -> None:
        self.recall(data.draw(st.sampled_from(sorted(self.set, key=repr))))

    @rule(account=st.text("ab c", min_size=1).filter(lambda name: name.strip() == name))
    def a_text_behind_a_request(self, account: str) -> None:
        for command in self.table.commands:
            if command.request_text is not None:
                given = dict.fromkeys(command.request_text.fields, account)
                self.tell(command.name)
                assert self.arm.receive(text.spell(command.request_text, given)) == b""
                assert (self.arm.state.ssid, self.arm.state.password) == (account, account)

    # What holds.

    @invariant()
    def joints_are_inside_their_limits_and_no_faster_than_they_can_be(self) -> None:
        before, seen = self.seen
        now, state = self.clock(), self.arm.state
        position = state.angles.position(now)
        self.seen = now, position
        most = FASTEST * (now - before) + ROUNDING
        pairs = zip(position, state.minimum, state.maximum)
        for joint, (angle, low, high) in enumerate(pairs):
            least, greatest = self.excused[joint]
            assert min(low, least) - ROUNDING <= angle <= max(high, greatest) + ROUNDING
            assert abs(angle - seen[joint]) <= most, "no joint jumps"
            if low <= angle <= high:
                self.excused[joint] = (low, high)

    @invariant()
    def after_a_stop_nothing_moves(self) -> None:
        if self.stopped_at is None or self.clock() < self.stopped_at + FASTEST / ACCELERATION:
            return
        position = self.arm.state.standing(self.clock())
        self.stood = self.stood or position
        assert position == self.stood
        assert not self.arm.state.angles.moving(self.clock())

    @invariant()
    def what_is_told_is_what_is(self) -> None:
        angles = self.reference.decode("reply", self.heard("get_angles")).values[0]
        exact = self.arm.state.angles.position(self.clock())
        assert all(abs(a - b) <= TICK / 2 + 0.01 for a, b in zip(angles, exact))

    @invariant()
    def time_goes_forward(self) -> None:
        times = [note.time for note in self.arm.notes]
        assert times == sorted(times)
        assert all(time <= self.clock() for time in times)

    # How it is done.

    def tell(self, name: str, *values: Any) -> None:
        """Send a request, hold its answer against the table, and remember what it set."""
        answer = self.heard(name, *values)
        self.expect_legal(self.table.command(name), answer)
        request = self.reference.decode("request", self.frame(name, *values)).fields
        self.note_motion(name)
        for getter in CHANGES.get(name, ()):
            self.set = {key: value for key, value in self.set.items() if key[0] != getter}
        getter = getter_of(self.table, name)
        if getter is not None:
            self.remember(getter, request)

    def frame(self, name: str, *values: Any) -> bytes:
        return self.reference.encode(name, "request", values)

    def heard(self, name: str, *values: Any) -> bytes:
        return self.arm.receive(self.frame(name, *values))

    def expect_legal(self, command: Command, answer: bytes) -> None:
        if command.text is not None:
            assert text.read(command.text, answer)
        elif command.reply:
            assert self.reference.decode("reply", answer, of=command.name).command is command
        else:
            assert answer == b""

    def note_motion(self, name: str) -> None:
        role = self.table.command(name).role
        if role == "stop":
            self.stopped_at, self.stood = self.clock(), None
        if name == "resume":
            self.stopped_at = None
        if name in CALIBRATIONS:
            self.stood = None
            self.seen = (self.clock(), self.arm.state.angles.position(self.clock()))
        if name in CALIBRATIONS or name.startswith("set_joint_m"):
            # A joint may stand outside of limits that came after it, and brakes beyond them.
            state, now = self.arm.state, self.clock()
            ends = zip(state.angles.position(now), state.angles.stop_at(now))
            self.excused = [(min(pair), max(pair)) for pair in ends]

    def remember(self, getter: Command, request: dict[str, Any]) -> None:
        form = _asking(getter, request)
        if form is None:
            return
        asked = tuple(request[field.name] for field in form.fields)
        key = getter.name, asked
        self.set = {old: value for old, value in self.set.items() if not _same(old, key)}
        self.set[key] = request
        self.recall(key)

    def recall(self, key: tuple[str, tuple[Any, ...]]) -> None:
        name, asked = key
        answer = self.reference.decode("reply", self.heard(name, *asked), of=name).fields
        given = self.set[key]
        for field, value in answer.items():
            if field in given and field not in ("joint", "pin"):
                expected = given[field]
                if name == "get_servo_data" and not given.get("mode"):
                    expected %= 256
                assert value == pytest.approx(expected, abs=0.051), name
        assert set(answer) & set(given), f"{name} tells something of what was set"


def _asking(getter: Command, request: dict[str, Any]) -> Layout | None:
    """The longest form of the getter's request that can be filled from the setter's."""
    forms = [
        form for form in getter.request if {field.name for field in form.fields} <= set(request)
    ]
    return max(forms, key=lambda form: form.size, default=None)


def _same(one: tuple[str, tuple[Any, ...]], two: tuple[str, tuple[Any, ...]]) -> bool:
    """Whether two questions are about the same thing: a mode behind joint and register is not."""
    return (one[0], one[1][:2]) == (two[0], two[1][:2])


TABLES = {table.edition: table for table in (mycobot.TABLE, mycobot280.TABLE)}
REQUESTS = {
    edition: [form for form in strategies.forms_of(table) if form.direction == "request"]
    for edition, table in TABLES.items()
}


@pytest.mark.parametrize("codec_name", ["reference", "native"])
@pytest.mark.parametrize("edition", list(TABLES))
def test_the_laws_hold_in_any_order(edition: str, codec_name: str) -> None:
    machine = type("Machine", (AnyOrder,), {"table": TABLES[edition], "codec_name": codec_name})
    run_state_machine_as_test(  # type: ignore[no-untyped-call]  # Hypothesis has no types there
        machine, settings=settings(settings.default, max_examples=EXAMPLES, stateful_step_count=30)
    )


EXAMPLES = 20


def test_setters_of_both_editions_have_their_getters() -> None:
    """What the machine reads back, so that a new pair is not forgotten."""
    found = {
        edition: {command.name for command in table.commands if getter_of(table, command.name)}
        for edition, table in TABLES.items()
    }
    assert len(found["mycobot"]) >= 11
    assert len(found["mycobot280"]) >= 15
