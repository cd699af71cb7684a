"""Typed messages: construction, equality, order on the wire, and classes made from a table."""

from __future__ import annotations

import copy
import math
import pickle
from collections.abc import Sequence
from enum import IntEnum
from typing import Any, NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire.codec.interface import Codec
from cobotwire.protocol.made_messages import class_name
from cobotwire.protocol.messages import Message, Reply, Request
from cobotwire.protocol.table import Direction, Table
from strategies import TABLES, codec_of, frame_of, messages


class Mode(IntEnum):
    SLOW = 0
    FAST = 1


class Point(NamedTuple):
    x: float
    y: float


class Both(NamedTuple):
    point: Point
    mode: Mode


class Go(Request[None], command="go"):
    point: Sequence[float]
    mode: Mode | int
    speed: int | None = None


class Turn(Request[None], command="turn", wire=("angle", 7, "joint"), radians=("angle",)):
    joint: int
    angle: float


class Join(Request[None], command="join", text=("password",)):
    channel: int
    password: str


class Where(Request[Both], command="where"):
    joint: int


class WhereReply(Reply[Both], to=Where, result=Both, wire=("joint", "point", "mode")):
    point: Point
    mode: Mode
    joint: int | None = None


class Aim(Request[float], command="aim"): ...


class AimReply(Reply[float], to=Aim, radians=("angle",)):
    angle: float


class Done(Request[None], command="done"): ...


class DoneReply(Reply[None], to=Done):
    done: bool | None = None


def test_message_names_its_command_and_its_counterpart() -> None:
    assert (Where.command, WhereReply.command) == ("where", "where")
    assert Where.reply_type is WhereReply
    assert WhereReply.request_type is Where
    assert Go.reply_type is None


def test_message_accepts_arguments_by_position_and_by_name() -> None:
    assert Go((1, 2), Mode.FAST) == Go(mode=Mode.FAST, point=(1, 2)) == Go((1, 2), 1, speed=None)
    assert Go((1, 2), 1) != Go((1, 2), 0)
    assert Aim() != Done()


@pytest.mark.parametrize(
    ("arguments", "named", "words"),
    [
        ((), {}, r"Go\(\) is missing its argument point"),
        (((1, 2),), {"speed": 3}, r"Go\(\) is missing its argument mode"),
        (((1, 2), 1, 2, 3), {}, r"Go\(\) takes 3 arguments, not 4"),
        (((1, 2), 1), {"point": (1, 2)}, r"Go\(\) got its argument point twice"),
        (((1, 2), 1), {"sped": 2}, r"Go\(\) has no argument sped"),
    ],
)
def test_wrong_arguments_raise_a_type_error(
    arguments: tuple[Any, ...], named: dict[str, Any], words: str
) -> None:
    with pytest.raises(TypeError, match=words):
        Go(*arguments, **named)


def test_message_is_immutable() -> None:
    message: Any = Where(1)
    with pytest.raises(AttributeError, match="Where is immutable; joint cannot be set"):
        message.joint = 2
    with pytest.raises(AttributeError, match="Where is immutable; joint cannot be deleted"):
        del message.joint
    assert message.joint == 1


def test_message_keeps_no_list_that_the_caller_can_change() -> None:
    point = [1.0, 2.0]
    message = Go(point, 1)
    point[0] = 9
    assert message.point == (1, 2)
    assert hash(message) == hash(Go((1, 2), 1))


def test_message_is_shown_as_the_call_that_makes_it() -> None:
    assert repr(Go([1, 2], 1)) == "Go(point=(1, 2), mode=1)"
    assert repr(Aim()) == "Aim()"


def test_message_matches_patterns_by_position_and_by_name() -> None:
    match Go((1, 2), Mode.FAST, 30):
        case Where():
            pytest.fail("a message of another type")
        case Go(point, speed=speed):
            assert (point, speed) == ((1, 2), 30)
        case _:
            pytest.fail("no case")


@pytest.mark.parametrize("message", [Go([1, 2], 1), Where(3), DoneReply()])
def test_message_survives_copying_and_pickling(message: Message) -> None:
    assert copy.deepcopy(message) == message
    assert pickle.loads(pickle.dumps(message)) == message


def test_request_values_are_in_wire_order_with_constants_and_degrees() -> None:
    assert Turn(2, math.pi).values == (180.0, 7, 2)
    assert Turn(2, math.pi).fields == {"joint": 2, "angle": 180.0}


def test_request_omits_trailing_none_arguments() -> None:
    assert Go((1, 2), 1).values == ((1, 2), 1)
    assert Go((1, 2), 1, 50).values == ((1, 2), 1, 50)
    assert Go((1, 2), 1).fields == {"point": (1, 2), "mode": 1}


def test_text_outside_the_frame_is_not_among_the_values() -> None:
    request = Join(3, "secret")
    assert request.values == (3,)
    assert request.text_values == {"password": "secret"}
    assert Where(3).text_values == {}


def test_reply_omits_an_echo_of_none() -> None:
    assert WhereReply(Point(1, 2), Mode.SLOW).values == ((1, 2), 0)
    assert WhereReply(Point(1, 2), Mode.SLOW, 4).values == (4, (1, 2), 0)


def test_reply_has_the_result_of_the_client_method() -> None:
    assert WhereReply(Point(1, 2), Mode.FAST).result == Both(Point(1, 2), Mode.FAST)
    assert AimReply(1.5).result == 1.5
    assert DoneReply(True).result is None


def test_decoded_fields_become_the_types_that_the_class_declares() -> None:
    request = Go.from_fields({"point": (1, 2), "mode": 1, "other": 5})
    assert request == Go((1, 2), Mode.FAST)
    assert isinstance(request.mode, Mode)
    reply = WhereReply.from_fields({"joint": 2, "point": (1.0, 2.0), "mode": 0})
    assert isinstance(reply.point, Point)
    assert reply.mode is Mode.SLOW
    assert AimReply.from_fields({"angle": 180.0}).angle == pytest.approx(math.pi)
    turned: Any = TABLES["mycobot280"].reply_type("get_radians")
    assert turned.from_fields({"radians": (180.0,) * 6}).radians.j6 == pytest.approx(math.pi)
    assert DoneReply.from_fields({"done": 1}).done is True


def test_number_outside_the_enum_stays_a_number() -> None:
    assert Go.from_fields({"point": (1, 2), "mode": 9}).mode == 9


@pytest.mark.parametrize(
    ("command", "expected"),
    [("get_angles", "GetAngles"), ("set_HTS_gripper_torque", "SetHTSGripperTorque")],
)
def test_class_name_is_the_command_in_camel_case(command: str, expected: str) -> None:
    assert class_name(command) == expected


@pytest.fixture(params=sorted(TABLES))
def table(request: pytest.FixtureRequest) -> Table:
    found: Table = TABLES[request.param]
    return found


def test_table_returns_the_message_types_of_each_command(table: Table) -> None:
    for command in table.commands:
        request, reply = table.request_type(command.name), table.reply_type(command.name)
        assert (request.command, request.__name__) == (command.name, class_name(command.name))
        assert request is table.request_type(command.name)
        assert (reply is None) == (not command.reply and command.text is None)
        assert request.reply_type is reply


@given(st.data())
def test_decoded_message_becomes_typed_and_encodes_to_the_same_frame(data: st.DataObject) -> None:
    edition = data.draw(st.sampled_from(sorted(TABLES)))
    codec = codec_of(edition, "reference")
    decoded = codec.decode(*_a_frame(data, codec))
    typed, command, direction = decoded.typed, decoded.command, decoded.direction
    expected = command.request_type if direction == "request" else command.reply_type
    assert type(typed) is expected
    variants = command.variants(direction)
    index = next(i for i, each in enumerate(variants) if each is decoded.variant)
    again = codec.encode(command.name, direction, typed.values, variant=index)
    assert codec.decode(direction, again).typed == typed


def _a_frame(data: st.DataObject, codec: Codec) -> tuple[Direction, bytes]:
    chosen, values = data.draw(messages(codec.table))
    return chosen.direction, frame_of(codec, chosen, values)
