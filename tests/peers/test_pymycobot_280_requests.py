"""Every request that pymycobot's MyCobot280 can build equals ours, except where listed."""

from __future__ import annotations

import inspect
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import strategies
from cobotwire.client import Client
from cobotwire.codec import CodecName
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.editions.mycobot280 import MyCobot280 as OurMyCobot280
from cobotwire.protocol.errors import UsageError
from pymycobot_280_differences import DIFFERENCES, TEXTS, rejected_by_pymycobot
from pymycobot_280_requests import COMPOSED, LACKING, LOCAL, REQUESTS
from pymycobot_classes import (
    REJECTIONS,
    MyCobot280,
    peer_on,
    recording_client,
    without_port,
    written,
)
from pymycobot_difference import M280, PALLETIZER, decoded_by, sent_by, sent_by_us
from pymycobot_ports import ReplyingPort
from robots.arguments import as_called
from strategies import codec_of

COMPARED = [command for command in TABLE.commands if command.name not in LACKING]
ASYNC = [
    command.name
    for command in COMPARED
    if "_async" in inspect.signature(getattr(MyCobot280, command.name)).parameters
]


def ours(codec: Codec) -> Client:
    return recording_client(codec.name, OurMyCobot280)


@pytest.mark.parametrize("command", [name for name in REQUESTS if name != "set_ssid_pwd"])
def test_request_equals_pymycobots_bytes(command: str, codec: Codec) -> None:
    for arguments in REQUESTS[command]:
        theirs = written(without_port(M280), command, arguments)
        assert written(ours(codec), command, arguments) == theirs, arguments


@pytest.mark.parametrize("account", REQUESTS["set_ssid_pwd"], ids=str)
def test_wireless_account_equals_pymycobots_frame_and_text(
    account: tuple[str, str], codec: Codec
) -> None:
    assert written(ours(codec), "set_ssid_pwd", account) == _all_written("set_ssid_pwd", account)


@pytest.mark.parametrize("text", TEXTS, ids=lambda text: ascii(text[0]))
def test_ambiguous_text_is_sent_by_pymycobot_only(text: tuple[str, str, str], codec: Codec) -> None:
    account, password, ruling = text
    text_on_wire = f"'{account}'({password})".encode()
    assert (
        _all_written("set_ssid_pwd", (account, password)) == b"\xfe\xfe\x02\xb0\xfa" + text_on_wire
    )
    with pytest.raises(UsageError):
        written(ours(codec), "set_ssid_pwd", (account, password))
    assert ruling


@pytest.mark.parametrize("composed", COMPOSED, ids=lambda call: str(call[0]))
def test_call_that_pymycobot_completes_or_composes_equals_a_request_of_ours(
    composed: tuple[str, tuple[Any, ...], str, tuple[Any, ...]], codec: Codec
) -> None:
    method, their_arguments, command, our_arguments = composed
    theirs = written(without_port(M280), method, their_arguments)
    assert written(ours(codec), command, our_arguments) == theirs


@pytest.mark.parametrize("command", ASYNC)
def test_async_flag_of_pymycobot_does_not_change_the_bytes(command: str, codec: Codec) -> None:
    for arguments in REQUESTS[command]:
        # _async is always the last parameter; optional ones before it are None.
        parameters = inspect.signature(getattr(MyCobot280, command)).parameters
        filled = (*arguments, *[None] * (len(parameters) - 2 - len(arguments)), True)
        theirs = written(without_port(M280), command, filled)
        assert written(ours(codec), command, arguments) == theirs


@pytest.mark.parametrize("key", DIFFERENCES, ids=" - ".join)
def test_listed_difference_exists_and_is_decoded_as_listed(
    key: tuple[str, str], codec: Codec
) -> None:
    difference = DIFFERENCES[key]
    theirs = sent_by(M280, difference)
    assert sent_by_us(ours(codec), key[0], difference) != theirs
    assert decoded_by(codec_of("mycobot280", codec.name), theirs) == difference.becomes
    assert difference.ruling


def test_all_108_commands_are_compared_and_exist_in_pymycobot() -> None:
    assert list(REQUESTS) == [command.name for command in COMPARED]
    assert len(REQUESTS) == 108
    for command in COMPARED:
        assert hasattr(MyCobot280, command.name)
        for variant in command.request:
            arguments = [field for field in variant.fields if field.cases[0].numbers[0].maximum > 0]
            sizes = [len(given) for given in REQUESTS[command.name]]
            assert len(arguments) in sizes or command.request_text, "each variant is compared"
            assert len(sizes) > 1 or not arguments


@pytest.mark.parametrize("command", LACKING)
def test_request_that_pymycobots_280_lacks_equals_that_of_its_palletizer(
    command: str, codec: Codec
) -> None:
    assert not hasattr(MyCobot280, command)
    theirs = written(without_port(PALLETIZER), command, ())
    assert written(ours(codec), command, ()) == theirs


def test_every_public_method_of_pymycobot_is_compared_or_sends_nothing() -> None:
    public = {name for name in dir(MyCobot280) if not name.startswith("_")}
    assert public == set(REQUESTS) | {call[0] for call in COMPOSED} | LOCAL


@pytest.mark.parametrize("codec_name", ["reference", "native"])
@given(data=st.data())
def test_legal_request_equals_pymycobots_bytes_or_pymycobot_rejects_it_by_a_ruling(
    data: st.DataObject, codec_name: CodecName
) -> None:
    variants = [
        f for f in strategies.variants_of(TABLE) if f.direction == "request" and f.variant.fields
    ]
    variant = data.draw(st.sampled_from(variants))
    name = variant.command.name
    arguments = as_called(
        variant.command, variant.variant, data.draw(strategies.legal_values(variant.variant))
    )
    request = written(recording_client(codec_name, OurMyCobot280), name, arguments)
    try:
        theirs = written(without_port(M280), name, arguments)
    except REJECTIONS:
        assert rejected_by_pymycobot(name), arguments
        return
    if theirs != request:
        assume(not _only_truncated(theirs, request))
    assert theirs == request


def test_illegal_request_is_sent_by_neither_side(codec: Codec) -> None:
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
        with pytest.raises(REJECTIONS):
            written(without_port(M280), command, arguments)
        with pytest.raises(UsageError):
            written(ours(codec), command, arguments)


def _only_truncated(theirs: bytes, request: bytes) -> bool:
    """Return whether the requests differ only in numbers that pymycobot truncated by one step."""
    read = [_numbers(decoded_by(codec_of("mycobot280", "reference"), s)) for s in (theirs, request)]
    steps = [round((abs(b) - abs(a)) * 100) for a, b in zip(*read, strict=True) if a != b]
    return bool(steps) and set(steps) <= {1, 10}


def _numbers(values: Any) -> list[float]:
    return [n for v in values for n in (v if isinstance(v, tuple) else (v,))]


def _all_written(method: str, arguments: tuple[Any, ...]) -> bytes:
    port = ReplyingPort()
    getattr(peer_on(M280, port), method)(*arguments)
    return port.written
