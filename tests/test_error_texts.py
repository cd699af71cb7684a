"""Check errors that are not about a bad value: they are sentences, and name what was called."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import get_args

import pytest

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.codec import CodecName
from cobotwire.conformance.reports import from_json
from cobotwire.editions.mycobot280 import GetAngles
from cobotwire.protocol.errors import ProtocolError, UsageError
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
