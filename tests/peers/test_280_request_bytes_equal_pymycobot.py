"""Every request that pymycobot's MyCobot280 can build equals ours, but for the listed ones."""

from __future__ import annotations

import inspect
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import strategies
from cobotwire.codec import CodecName
from cobotwire.codec.interface import Codec
from cobotwire.driver import Driver
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.editions.mycobot280 import MyCobot280 as OurMyCobot280
from cobotwire.errors import UsageError
from pymycobot_280_differences import DIFFERENCES, TEXTS, refused_by_pymycobot
from pymycobot_280_requests import REQUESTS, SAME_WISHES, SILENT, as_called
from pymycobot_classes import REFUSALS, MyCobot280, our_client, peer_on, without_port, written
from pymycobot_difference import M280, read_by, said_by, said_by_us
from strategies import codec_of

ASYNC = [
    command.name
    for command in TABLE.commands
    if "_async" in inspect.signature(getattr(MyCobot280, command.name)).parameters
]


def ours(codec: Codec) -> Driver:
    return our_client(codec.name, OurMyCobot280)


@pytest.mark.parametrize("command", [name for name in REQUESTS if name != "set_ssid_pwd"])
def test_a_request_is_the_same_bytes_as_pymycobots(command: str, codec: Codec) -> None:
    for arguments in REQUESTS[command]:
        theirs = written(without_port(M280), command, arguments)
        assert written(ours(codec), command, arguments) == theirs, arguments


@pytest.mark.parametrize("account", REQUESTS["set_ssid_pwd"], ids=str)
def test_the_wireless_account_is_the_same_frame_and_the_same_text(
    account: tuple[str, str], codec: Codec
) -> None:
    assert written(ours(codec), "set_ssid_pwd", account) == _all_written("set_ssid_pwd", account)


@pytest.mark.parametrize("text", TEXTS, ids=lambda text: ascii(text[0]))
def test_a_text_that_could_be_read_otherwise_is_sent_by_pymycobot_alone(
    text: tuple[str, str, str], codec: Codec
) -> None:
    account, password, ruling = text
    said = f"'{account}'({password})".encode()
    assert _all_written("set_ssid_pwd", (account, password)) == b"\xfe\xfe\x02\xb0\xfa" + said
    with pytest.raises(UsageError):
        written(ours(codec), "set_ssid_pwd", (account, password))
    assert ruling


@pytest.mark.parametrize("wish", SAME_WISHES, ids=lambda wish: str(wish[0]))
def test_what_pymycobot_fills_in_or_composes_is_a_request_of_ours(
    wish: tuple[str, tuple[Any, ...], str, tuple[Any, ...]], codec: Codec
) -> None:
    method, theirs, command, given_to_us = wish
    said = written(without_port(M280), method, theirs)
    assert written(ours(codec), command, given_to_us) == said


@pytest.mark.parametrize("command", ASYNC)
def test_not_waiting_for_the_answer_does_not_change_the_bytes(command: str, codec: Codec) -> None:
    for arguments in REQUESTS[command]:
        # _async is the last parameter everywhere; what may be left out before it is None.
        parameters = inspect.signature(getattr(MyCobot280, command)).parameters
        filled = (*arguments, *[None] * (len(parameters) - 2 - len(arguments)), True)
        theirs = written(without_port(M280), command, filled)
        assert written(ours(codec), command, arguments) == theirs


@pytest.mark.parametrize("key", DIFFERENCES, ids=" - ".join)
def test_a_listed_difference_is_one_and_becomes_what_the_list_says(
    key: tuple[str, str], codec: Codec
) -> None:
    difference = DIFFERENCES[key]
    theirs = said_by(M280, difference)
    assert said_by_us(ours(codec), key[0], difference) != theirs
    assert read_by(codec_of("mycobot280", codec.name), theirs) == difference.becomes
    assert difference.ruling


def test_all_108_calls_are_compared_and_none_is_beyond_pymycobot() -> None:
    assert list(REQUESTS) == [command.name for command in TABLE.commands]
    assert len(REQUESTS) == 108
    for command in TABLE.commands:
        assert hasattr(MyCobot280, command.name)
        for form in command.request:
            asked = [field for field in form.fields if field.cases[0].numbers[0].maximum > 0]
            sizes = [len(given) for given in REQUESTS[command.name]]
            assert len(asked) in sizes or command.request_text, "each form is compared"
            assert len(sizes) > 1 or not asked


def test_every_public_method_of_pymycobot_is_compared_or_says_nothing() -> None:
    public = {name for name in dir(MyCobot280) if not name.startswith("_")}
    assert public == set(REQUESTS) | {wish[0] for wish in SAME_WISHES} | SILENT


@pytest.mark.parametrize("codec_name", ["reference", "native"])
@given(data=st.data())
def test_what_our_table_allows_pymycobot_says_in_the_same_bytes_or_refuses_by_a_ruling(
    data: st.DataObject, codec_name: CodecName
) -> None:
    forms = [f for f in strategies.forms_of(TABLE) if f.direction == "request" and f.layout.fields]
    form = data.draw(st.sampled_from(forms))
    name = form.command.name
    arguments = as_called(name, form.layout, data.draw(strategies.legal_values(form.layout)))
    request = written(our_client(codec_name, OurMyCobot280), name, arguments)
    try:
        theirs = written(without_port(M280), name, arguments)
    except REFUSALS:
        assert refused_by_pymycobot(name), arguments
        return
    if theirs != request:
        assume(not _cut(theirs, request))
    assert theirs == request


def test_what_neither_side_can_say_is_sent_by_neither(codec: Codec) -> None:
    for command, arguments in [
        ("send_angle", (1, 168.1, 50)),
        ("send_angle", (7, 0, 50)),
        ("send_angles", ([0] * 6, 0)),
        ("send_angles", ([0] * 5, 50)),
        ("send_coord", (1, 281.5, 50)),
        ("send_coords", ([0, 0, -70.1, 0, 0, 0], 50)),
        ("jog_increment", (1, 328, 50)),
        ("jog_rpy", (4, 1, 50)),
        ("set_encoder", (8, 0, 50)),
        ("set_encoder", (1, 4097, 50)),
        ("set_servo_data", (1, 4, 1)),
        ("set_servo_data", (1, 24, 256)),
        ("get_servo_data", (1, 256)),
        ("set_pin_mode", (256, 1)),
        ("set_digital_output", (20, 1)),
        ("set_basic_output", (1, 1)),
        ("get_gripper_value", (2,)),
        ("set_gripper_state", (2, 50)),
        ("set_HTS_gripper_torque", (149,)),
        ("set_gripper_protect_current", (501,)),
        ("backup_servo_params", (7,)),
        ("focus_servo", (0,)),
        ("set_joint_min", (5, 161)),
        ("set_pwm_output", (1, 1, 256)),
    ]:
        with pytest.raises(REFUSALS):
            written(without_port(M280), command, arguments)
        with pytest.raises(UsageError):
            written(ours(codec), command, arguments)


def _cut(theirs: bytes, request: bytes) -> bool:
    """Whether pymycobot's is our request but for numbers that are one step nearer to zero."""
    read = [_numbers(read_by(codec_of("mycobot280", "reference"), s)) for s in (theirs, request)]
    steps = [round((abs(b) - abs(a)) * 100) for a, b in zip(*read, strict=True) if a != b]
    return bool(steps) and set(steps) <= {1, 10}


def _numbers(values: Any) -> list[float]:
    return [n for v in values for n in (v if isinstance(v, tuple) else (v,))]


class CollectingPort:
    """A port that hears all that is written and never answers."""

    def __init__(self) -> None:
        self.data = b""

    def isOpen(self) -> bool:
        return True

    def write(self, data: Any) -> None:
        self.data += bytes(data)

    def read(self) -> bytes:
        return b""


def _all_written(method: str, arguments: tuple[Any, ...]) -> bytes:
    port = CollectingPort()
    getattr(peer_on(M280, port), method)(*arguments)
    return port.data
