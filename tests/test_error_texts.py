"""Check errors that are not about a bad value: they are sentences, and name the call."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

import pytest

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.codec import CodecName
from cobotwire.codec.interface import Noise
from cobotwire.conformance.reports import from_json
from cobotwire.diagnose import DamagedFrame, Diagnoser
from cobotwire.editions.mycobot280 import GetAngles, PowerOn, SendRadians, SetEndType
from cobotwire.protocol import error_texts
from cobotwire.protocol.error_texts import stored_texts
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.messages import Request
from cobotwire.session.received import ReceivedMeanwhile
from cobotwire.session.request import RequestEncoder
from cobotwire.session.sampling import Sampler, check_requests
from cobotwire.simulator.faults import find
from cobotwire.simulator.testing.options import combined
from cobotwire.transport import open_transport

TABLE = editions.load("mycobot280").TABLE
REPLY = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
OLD_REPORT = {"format": "cobotwire-conformance", "version": 0}


def _take_twice() -> None:
    sampler = Sampler((GetAngles(),), 10.0)
    sampler.plan(0.0)
    sampler.plan(0.1)


def _missing_column() -> None:
    columns = codecs.load(TABLE).decode_columns(REPLY, "reply")
    columns.rows("get_angles")["j9"]


SENTENCES: dict[str, tuple[Callable[[], object], str]] = {
    "stream": (
        _take_twice,
        "a stream has one consumer, and one waits already; open another stream",
    ),
    "request": (
        lambda: check_requests((GetAngles(), GetAngles()), TABLE),
        "requests[1] repeats GetAngles(); a stream sends each query once",
    ),
    "query": (
        lambda: check_requests((PowerOn(),), TABLE),
        "requests[0] is power_on, which is not a query; a stream can send ",
    ),
    "scenario": (lambda: find("pannic"), "there is no scenario 'pannic'; did you mean panic?"),
    "mark": (
        lambda: combined([((), {"sped": 2})], Path()),
        "simulated_arm has no argument sped; it takes ",
    ),
    "column": (_missing_column, "get_angles reply has no column 'j9'; choose from "),
    "report": (
        lambda: from_json(json.dumps(OLD_REPORT)),
        "the report is in the format cobotwire-conformance, version 0; needed: ",
    ),
    "pyserial": (lambda: open_transport("nosuch://x:1", 9600), "pyserial cannot open nosuch://x:1"),
}


@pytest.mark.parametrize("name", SENTENCES)
def test_error_that_is_not_about_a_value_is_a_sentence(name: str) -> None:
    act, sentence = SENTENCES[name]
    with pytest.raises(UsageError) as caught:
        act()
    assert str(caught.value).startswith(sentence)
    assert "allowed:" not in str(caught.value)


@pytest.mark.parametrize("codec", get_args(CodecName))
@pytest.mark.parametrize(
    ("direction", "id", "names"),
    [
        ("reply", 0x20, "get_angles or get_radians"),
        ("request", 0x22, "send_angles or send_radians"),
    ],
)
def test_length_error_names_every_command_that_shares_the_id(
    codec: CodecName, direction: str, id: int, names: str
) -> None:
    frame = bytes([0xFE, 0xFE, 0x03, id, 0x01, 0xFA])
    with pytest.raises(ProtocolError) as caught:
        codecs.load(TABLE, codec).decode(direction, frame)  # type: ignore[arg-type]
    assert f"LEN of the {direction} {id:02X} ({names}) is 03" in str(caught.value)


@pytest.mark.parametrize("codec", get_args(CodecName))
@pytest.mark.parametrize(
    ("request_", "text"),
    [
        (
            SendRadians([999, 0, 0, 0, 0, 0], 30),
            "radians.j1 is 999; allowed: a number -2.9321..2.9321 radians",
        ),
        (
            SendRadians([0, 0, 0, 0, 0, "x"], 30),  # type: ignore[list-item]
            "radians.j6 is 'x'; allowed: a number -3.1415..3.1415 radians",
        ),
        (SendRadians(3, 30), "radians is 3; allowed: a sequence of 6 numbers"),  # type: ignore[arg-type]
        (SendRadians([0] * 6, 101), "speed is 101; allowed: a whole number 1..100 percent"),
        (SetEndType(7), "end is 7; allowed: FLANGE (0), TOOL (1)"),
    ],
)
def test_error_of_an_argument_has_the_units_and_names_of_the_caller(
    codec: CodecName, request_: Request[Any], text: str
) -> None:
    encoder = RequestEncoder(codecs.load(TABLE, codec))
    with pytest.raises(UsageError) as caught:
        encoder.encode_request(request_)
    assert str(caught.value).startswith(text)


@pytest.mark.parametrize("codec", get_args(CodecName))
def test_bounds_in_radians_are_allowed_values(codec: CodecName) -> None:
    encoder = RequestEncoder(codecs.load(TABLE, codec))
    for bound in (-2.9321, 2.9321):
        encoder.encode_request(SendRadians([bound, 0, 0, 0, 0, 0], 30))


@pytest.mark.parametrize("name", ["get_angles", "get_radians"])
def test_timeout_names_the_command_that_was_called_in_a_damaged_reply(name: str) -> None:
    codec = codecs.load(TABLE)
    received = ReceivedMeanwhile()
    for event in [*(framer := codec.framer("reply")).feed(REPLY[:-1] + b"\xfb"), *framer.flush()]:
        assert isinstance(event, Noise)
        received.add(event)
    [line] = received.lines(codec, bytes.fromhex("FE FE 02 20 FA"), TABLE.command(name))
    assert f"damaged {name}: its end or check is wrong" in line


def test_diagnosis_without_a_call_names_every_command_that_shares_the_id() -> None:
    codec = codecs.load(TABLE)
    diagnoser, framer = Diagnoser(codec), codec.framer("reply")
    diagnoser.feed([*framer.feed(REPLY[:-1] + b"\xfb"), *framer.flush()])
    [found] = diagnoser.flush()
    assert isinstance(found, DamagedFrame)
    assert found.command == "get_angles or get_radians"


@pytest.mark.parametrize("name", ["error_texts.json", "units.json"])
def test_each_template_has_a_line_without_escapes_and_plain_names_as_places(name: str) -> None:
    """Other languages read the file line by line."""
    path = Path(error_texts.__file__).with_name(name)
    lines = [line for line in path.read_text(encoding="ascii").splitlines() if line.strip("{}")]
    assert lines
    for line in lines:
        assert re.fullmatch(r'"[\w-]+": "([^"\\{}]|{[a-z]+})+",?', line), line
    assert len(lines) == len(stored_texts(name))


def test_every_template_is_used_and_every_named_kind_has_one() -> None:
    root = Path(__file__).parents[1]
    files = [*root.glob("python/cobotwire/**/*.py"), *root.glob("rust/*/src/**/*.rs")]
    source = "".join(file.read_text(encoding="utf-8") for file in files)
    kinds = set(re.findall(r'(?:error_text\(|text!\()"([a-z-]+)"', source))
    stored = stored_texts("error_texts.json").keys()
    assert len(kinds) > 50
    assert kinds <= stored
    made = ("-with-unit", "-by-deadline")
    assert [k for k in stored if f'"{k}"' not in source and not k.endswith(made)] == []


def test_value_that_looks_like_a_placeholder_is_not_replaced() -> None:
    error = UsageError("joint", "{allowed} {argument.__class__}", "{value}")
    assert str(error) == "joint is '{allowed} {argument.__class__}'; allowed: {value}"
