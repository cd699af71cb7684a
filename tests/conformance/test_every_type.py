"""Devices, clients and codecs of a made-up sensor with every type of the language conform."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.conformance.client import Referee, ScriptLine, faulty_replies
from cobotwire.conformance.codec import Run, derive_questions
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.conformance.codec.questions.question import Json, Question
from cobotwire.conformance.report import Report
from cobotwire.simulator import MemoryTransport, SteppedClock
from conformance.device.testing import altering, prepared
from random_editions import SENSOR
from trial_specs import imported


@pytest.fixture(scope="module")
def sensor(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """Yield the generated package of the sensor."""
    with imported(SENSOR, tmp_path_factory.mktemp("conform")) as package:
        yield package


@pytest.fixture(scope="module")
def questions(sensor: Any) -> list[Question]:
    return list(derive_questions(sensor.TABLE))


def failed(report: Report) -> set[tuple[str, str]]:
    return {(result.case, result.command) for result in report.failures}


def test_right_device_conforms(sensor: Any) -> None:
    report = prepared(sensor.TABLE).run()
    assert report.conforms, report.failures
    tested = {result.command for result in report.results if result.case == "read-back"}
    assert tested == {"set_torque", "set_status", "write_memory", "set_name"}


@pytest.mark.parametrize(
    ("command", "setter", "place"),
    [("read_memory", "write_memory", -2), ("get_name", "set_name", 9)],
)
def test_device_that_changes_a_byte_of_a_value_fails(
    sensor: Any, command: str, setter: str, place: int
) -> None:
    def changed(reply: bytes) -> bytes:
        data = bytearray(reply)
        data[place] ^= len(reply) >= 9
        return bytes(data)

    report = prepared(sensor.TABLE, altering(sensor.TABLE, command, changed)).run()
    assert ("read-back", setter) in failed(report)


@pytest.mark.parametrize("name", ["reference", "native"])
def test_right_codec_conforms(
    sensor: Any, questions: list[Question], name: codecs.CodecName
) -> None:
    # All 43,000 questions take seconds; a prime step still includes every kind.
    codec = OurCodec(codecs.load(sensor.TABLE, name))
    assert Run(sensor.TABLE, codec).ask_all(questions[::43]).conforms


class Changed(OurCodec):
    """A codec that changes the fields of its answers."""

    def __init__(self, table: Any, change: Callable[[str, Any], Any]) -> None:
        super().__init__(codecs.load(table))
        self._change = change

    def ask(self, question: Json) -> Json:
        answer = super().ask(question)
        fields = {name: self._change(name, v) for name, v in answer.get("fields", {}).items()}
        return answer | ({"fields": fields} if fields else {})


def lower(name: str, value: Any) -> Any:
    return value.lower() if name == "data" else value


def wrong(name: str, value: Any) -> Any:
    """Return texts in upper case, and bytes in reverse."""
    if name == "data" and isinstance(value, str):
        return bytes.fromhex(value)[::-1].hex()
    return value.upper() if name == "note" else value


def test_bytes_of_fields_may_be_written_in_lower_case(
    sensor: Any, questions: list[Question]
) -> None:
    some = [q for q in questions if q.command == "write_memory" and q.case.id == "decode-values"]
    assert some
    assert Run(sensor.TABLE, Changed(sensor.TABLE, lower)).ask_all(some).conforms


def test_codec_that_changes_texts_and_bytes_fails(sensor: Any, questions: list[Question]) -> None:
    about = {"set_name", "write_memory", "set_torque"}
    some = [q for q in questions if q.command in about and q.case.id == "decode-values"]
    found = failed(Run(sensor.TABLE, Changed(sensor.TABLE, wrong)).ask_all(some))
    assert found == {("decode-values", "set_name"), ("decode-values", "write_memory")}


CALLS: list[tuple[str, tuple[Any, ...], tuple[Any, ...]]] = [
    ("set_torque", (-2.5,), (-2.5,)),
    ("set_status", ((True, 2, 9, -4),), ((True, 2, 9, -4),)),
    ("write_memory", (3, b"\xca\xfe", True), (3, ..., b"\xca\xfe", True)),
    ("set_name", ("left", b"1234", "à côté"), ("left", b"1234", "à côté")),
    ("set_temperatures", ([20, 30],), ((20, 30),)),
    ("get_satellites", (), ()),
    ("get_joints", (), ()),
]


@pytest.mark.parametrize("mistaken", [False, True])
def test_client_is_tested_with_values_of_every_type(sensor: Any, mistaken: bool) -> None:
    clock = SteppedClock()
    script = [
        ScriptLine(sensor.TABLE.command(name), values, name, None) for name, _, values in CALLS
    ]
    scenario = faulty_replies(0.008, ["split"], 2)
    referee = Referee(sensor.TABLE, scenario=scenario, script=script, clock=clock)
    with sensor.CLIENT(MemoryTransport(referee, clock), on_error="leave") as client:
        for name, arguments, _ in CALLS:
            if mistaken and name == "write_memory":
                arguments = (3, b"\xca\xff", True)
            if mistaken and name == "set_name":
                arguments = ("left", b"1234", "à cote")
            getattr(client, name)(*arguments)
            clock.sleep(1.0)
    commands = {command for _, command in failed(referee.finish())}
    assert commands == ({"write_memory", "set_name"} if mistaken else set())
