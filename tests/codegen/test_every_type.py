"""The codec, the client and the command line read and write every type of a made-up sensor."""

from __future__ import annotations

import math
from typing import Any

import pytest

import small_specs
from cobotwire import codec as codecs
from cobotwire.diagnose.explain import format_message, frame_parts
from cobotwire.inspect import call_arguments
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.simulator import PtyServer, SimulatedArm
from targets.specs import edition_of

CODECS: tuple[codecs.CodecName, ...] = ("reference", "native")
each_codec = pytest.mark.parametrize("name", CODECS)


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Generate the package of the made-up sensor, and import it."""
    return small_specs.package(tmp_path_factory.mktemp("sensor"), edition_of("sensor"))


@each_codec
def test_vectors_decode_to_typed_messages_that_encode_to_the_same_bytes(
    package: Any, name: codecs.CodecName
) -> None:
    table = package.TABLE
    codec = codecs.load(table, name)
    for vector in edition_of("sensor").vectors:
        assert vector.frame is not None
        decoded = codec.decode(vector.direction, vector.frame, of=vector.command)
        message = decoded.typed
        assert codec.encode(vector.command, vector.direction, message.values) == vector.frame
        parts = list(frame_parts(table, vector.frame, decoded))
        assert b"".join(part.data for part in parts) == vector.frame
        assert format_message(decoded)


def test_generated_client_sets_and_reads_every_type_on_a_simulated_sensor(package: Any) -> None:
    Mode = package.Mode
    with PtyServer(SimulatedArm(package.TABLE)) as server, package.CLIENT(server.url) as sensor:
        sensor.set_torque(-2.5)
        assert sensor.get_torque() == (-2.5, 0.0, 0.0)
        sensor.set_status((True, Mode.OFF, 9, -4))
        status = sensor.get_status()
        assert (status.ready, status.mode, status.level, status.offset) == (True, Mode.OFF, 9, -4)
        sensor.write_memory(3, b"\xca\xfe", verify=True)
        assert (sensor.read_memory(3), sensor.read_memory(4)) == (b"\xca\xfe", b"")
        sensor.set_name("left", bytearray(b"1234"), "à côté")
        assert sensor.get_name() == ("left", b"1234", "à côté")
        joints, modes = sensor.get_joints()
        assert [joint.temperature for joint in joints] == [0, 0, 0, 0]
        assert modes == (Mode.SLOW,) * 3
        assert sensor.get_satellites() == ((), ())
        sensor.set_temperatures([20, 30])


@pytest.mark.parametrize(
    ("method", "arguments", "message"),
    [
        (
            "set_temperatures",
            ([1, 300],),
            r"temperatures\[1\] is 300; allowed: a whole number 0..2",
        ),
        ("set_temperatures", ([1] * 41,), r"len\(temperatures\) is 41; allowed: 0..40"),
        ("write_memory", (1, b"x" * 41, True), r"len\(data\) is 41; allowed: 0..40"),
        ("write_memory", (1, "x", True), "data is 'x'; allowed: bytes"),
        ("set_name", ("é", b"1234", ""), "label is 'é'; allowed: ASCII text of at most 8 bytes"),
        ("set_name", ("x" * 9, b"1234", ""), "label is 'xxxxxxxxx'; allowed: ASCII text"),
        ("set_name", ("x", b"123", ""), r"len\(serial\) is 3; allowed: 4"),
        ("set_name", ("x", b"1234", "x" * 31), r"len\(note\) is 31; allowed: 0..30"),
        ("set_status", ((1, 7, 9, 0),), r"status.mode is 7; allowed: SLOW \(0\), FAST \(1\)"),
        ("set_status", ((1, 1, 64, 0),), "status.level is 64; allowed: a whole number 0..63"),
        ("set_torque", (math.nan,), "torque is nan; allowed: a number -50..50 newton metres"),
    ],
)
@each_codec
def test_illegal_value_is_refused_with_its_element(
    package: Any, name: codecs.CodecName, method: str, arguments: Any, message: str
) -> None:
    codec = codecs.load(package.TABLE, name)
    request = package.TABLE.request_type(method)(*arguments)
    with pytest.raises(UsageError, match=message):
        codec.encode(method, "request", request.values)


@pytest.mark.parametrize(
    ("command", "data", "message"),
    [
        ("get_torque", "00 00 C0 7F" + " 00" * 12, "torque is nan"),
        ("get_status", "06 00", r"status.mode is 3; allowed: SLOW"),
        ("get_name", "6C E9" + " 00" * 10, "byte 1 of label is E9, not ascii"),
        ("get_name", "6C" + " 00" * 11 + " C3 28", "byte 0 of note is C3, not utf-8"),
        ("get_satellites", "01 09 00 00 00 00", r"satellites\[0\].channel is 9; allowed: a whole"),
    ],
)
def test_both_codecs_refuse_malformed_data_with_the_same_text(
    package: Any, command: str, data: str, message: str
) -> None:
    body = bytes.fromhex(data)
    id = package.TABLE.command(command).id
    frame = b"\xfe\xfe" + bytes([len(body) + 2, id]) + body + b"\xfa"
    texts = []
    for name in CODECS:
        with pytest.raises(ProtocolError, match=message) as caught:
            codecs.load(package.TABLE, name).decode("reply", frame)
        texts.append(str(caught.value))
    assert texts[0] == texts[1]


@pytest.mark.parametrize(
    ("command", "words", "frame"),
    [
        ("write_memory", ["3", "CA FE", "on"], "FE FE 07 25 03 02 CA FE 01 FA"),
        ("set_status", ["0,2,1,7"], "FE FE 04 23 14 1C FA"),
        ("set_temperatures", ["20,21,22"], "FE FE 05 2A 14 15 16 FA"),
        ("set_temperatures", [""], "FE FE 02 2A FA"),
        (
            "set_name",
            ["x", "0A0B0C0D", "ok"],
            "FE FE 10 27 78 00 00 00 00 00 00 00 0A 0B 0C 0D 6F 6B FA",
        ),
    ],
)
def test_words_of_the_command_line_become_values_of_every_type(
    package: Any, command: str, words: list[str], frame: str
) -> None:
    record = package.TABLE.command(command)
    given = call_arguments.parse(record, words)
    values = call_arguments.request_values(record, given)
    index = call_arguments.variant_of(record, given)
    for name in CODECS:
        codec = codecs.load(package.TABLE, name)
        assert codec.encode(command, "request", values, variant=index) == bytes.fromhex(frame)
