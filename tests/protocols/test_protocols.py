"""Protocols of other devices, from their specs alone: generated, framed, simulated, tested.

None of them has the maker's layout. Where a spec names no source of a frame, only its check is
known to be right.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Frame, Noise
from cobotwire.conformance import Verdict
from cobotwire.protocol.errors import UsageError
from cobotwire.simulator import PtyServer, SimulatedArm
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import render_python
from cobotwire_codegen.render.vectors_json import plain
from cobotwire_codegen.targets.c import render_c
from cobotwire_codegen.targets.vectors.law import Law, Reading
from conformance.device.testing import prepared

HERE = Path(__file__).parent
NAMES = ["feetech", "dynamixel", "ublox"]
CODECS: tuple[codecs.CodecName, ...] = ("reference", "native")


def edition_of(name: str) -> Edition:
    edition = build_edition(HERE / f"{name}.yaml", HERE)
    check(edition)
    return edition


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Return a function that generates a protocol's package and imports it."""
    folder = tmp_path_factory.mktemp("protocols")
    sys.path.insert(0, str(folder))

    def make(name: str) -> Any:
        if not (folder / f"protocol_{name}").exists():
            write(Target(folder / f"protocol_{name}", render_python(edition_of(name))))
            importlib.invalidate_caches()
        return importlib.import_module(f"protocol_{name}")

    yield make
    sys.path.remove(str(folder))


@pytest.mark.parametrize("codec", CODECS)
@pytest.mark.parametrize("name", NAMES)
def test_frames_of_the_spec_are_encoded_decoded_and_found_in_noise(
    package: Any, name: str, codec: codecs.CodecName
) -> None:
    edition, used = edition_of(name), codecs.load(package(name).TABLE, codec)
    for vector in edition.vectors:
        assert vector.frame is not None
        values = tuple(plain(edition, vector, field, value) for field, value in vector.values)
        message = used.decode(vector.direction, vector.frame, of=vector.command)
        assert (message.command.name, message.values) == (vector.command, values)
        assert used.encode(vector.command, vector.direction, values) == vector.frame
        events = used.framer(vector.direction).feed(b"\xff\xb5" + vector.frame + b"\0")
        assert [event.data for event in events if isinstance(event, Frame)] == [vector.frame]
        law = Law(edition, vector.direction)
        assert isinstance(law.read(vector.frame), Reading)
        broken = vector.frame[:-1] + bytes([vector.frame[-1] ^ 1])
        framer = used.framer(vector.direction)
        found = [*framer.feed(broken), *framer.flush()]
        assert all(isinstance(event, Noise) for event in found)


@pytest.mark.parametrize("name", NAMES)
def test_simulated_device_conforms(package: Any, name: str) -> None:
    report = prepared(package(name).TABLE).run()
    assert [r for r in report.results if r.verdict is Verdict.FAIL] == []
    assert any(r.verdict is Verdict.PASS for r in report.results)


def test_replies_without_id_are_matched_by_size_and_address(package: Any) -> None:
    feetech = package("feetech")
    with PtyServer(SimulatedArm(feetech.TABLE)) as server, feetech.CLIENT(server.url) as servo:
        assert servo.ping() == 0
        assert servo.read_position() == (0, 0)
        assert servo.write_goal(2048, 0, 1000) == 0


def test_receiver_remembers_its_rate(package: Any) -> None:
    ublox = package("ublox")
    with PtyServer(SimulatedArm(ublox.TABLE)) as server, ublox.CLIENT(server.url) as receiver:
        receiver.set_rate(200, 1, 1)
        assert receiver.get_rate() == (200, 1, 1)


@pytest.mark.parametrize("codec", CODECS)
def test_stream_of_status_packets_is_read_as_the_first_message_of_their_size(
    package: Any, codec: codecs.CodecName
) -> None:
    used = codecs.load(package("feetech").TABLE, codec)
    stream = bytes.fromhex("FF FF 01 03 00 79 82  FF FF 07 04 00 18 05 D7")
    framer = used.framer("both")
    found = [event for event in framer.feed(stream) if isinstance(event, Frame)]
    assert [event.message.command.name for event in found] == ["read_voltage", "read_position"]
    assert [event.message.address for event in found] == [1, 7]
    _, row = used.decode_columns(stream, "reply")
    assert row["voltage"].tolist() == [12.1]


def test_sync_write_to_every_servo_carries_each_goal(package: Any) -> None:
    frame = bytes.fromhex("FF FF FE 0E 83 1E 04 00 10 00 50 01 01 20 02 60 03 67")
    for codec in CODECS:
        used = codecs.load(package("dynamixel").TABLE, codec)
        message = used.decode("request", frame)
        assert message.values == (0x1E, 4, 0, 0x10, 0x150, 1, 0x220, 0x360)
        assert used.encode("sync_write_goals", "request", message.values, address=254) == frame
        with pytest.raises(UsageError, match=r"address is 255; allowed: 1, 254, 0, 2\.\.253"):
            used.encode("ping", "request", (), address=255)


def test_targets_without_such_frames_refuse_them() -> None:
    for name in NAMES:
        with pytest.raises(SpecError, match="cannot express the frames of"):
            render_c(edition_of(name))
