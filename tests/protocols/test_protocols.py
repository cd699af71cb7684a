"""Protocols of other devices, from their specs alone: generated, called, simulated, tested.

None of them has the maker's frame format. Where a spec names no source of a frame, only its check
is known to be right. ``tests/targets`` compares their codecs and targets.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Frame
from cobotwire.conformance import Verdict
from cobotwire.diagnose.explain import format_message
from cobotwire.protocol.errors import UsageError
from cobotwire.simulator import PtyServer, SimulatedArm
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from conformance.device.testing import prepared
from targets.specs import FILES, edition_of

NAMES = ["feetech", "ublox"]
CODECS: tuple[codecs.CodecName, ...] = ("reference", "native")


@pytest.mark.parametrize("name", NAMES)
def test_simulated_device_conforms(package: Any, name: str) -> None:
    report = prepared(package(name).TABLE).run()
    assert [r for r in report.results if r.verdict is Verdict.FAIL] == []
    assert any(r.verdict is Verdict.PASS for r in report.results)


def test_replies_without_id_are_matched_by_size_and_address(package: Any) -> None:
    feetech = package("feetech")
    with PtyServer(SimulatedArm(feetech.TABLE)) as server, feetech.CLIENT(server.url) as servo:
        healthy = feetech.ServoErrors(*[False] * 5)
        assert servo.ping() == healthy
        assert servo.read_position() == (healthy, 0)
        assert servo.write_goal(2048, 0, 1000) == healthy


def test_receiver_remembers_its_rate(package: Any) -> None:
    ublox = package("ublox")
    with PtyServer(SimulatedArm(ublox.TABLE)) as server, ublox.CLIENT(server.url) as receiver:
        receiver.set_rate(200, 1, 1)
        assert receiver.get_rate() == (200, 1, 1)


@pytest.mark.parametrize("codec", CODECS)
def test_reply_without_id_is_decoded_as_the_first_message_of_its_size(
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


def test_sync_write_goes_to_every_servo(package: Any) -> None:
    feetech = package("feetech")
    arm, frames = SimulatedArm(feetech.TABLE), list[bytes]()
    with PtyServer(arm) as server, feetech.CLIENT(server.url) as servo:
        servo.add_traffic_listener(lambda traffic: frames.append(traffic.data))
        servo.every.sync_write_goals([feetech.ServoTarget(n, 2048, 0, 1000) for n in range(1, 5)])
    assert frames == [v.frame for v in edition_of("feetech").vectors if v.name == "sync"]
    for codec in CODECS:
        used = codecs.load(feetech.TABLE, codec)
        with pytest.raises(UsageError, match=r"address is 255; allowed: 1, 254, 0, 2\.\.253"):
            used.encode("ping", "request", (), address=255)


def test_derived_vectors_keep_their_address(tmp_path: Path) -> None:
    text = FILES["feetech"].read_text()
    (tmp_path / "feetech.yaml").write_text(text)
    frame = text[text.index("frame:\n") : text.index("types:")].replace("inverted-sum", "sum")
    head = "edition: other\nclass: Other\ntitle: Other\ndoc: Other.\nbase: feetech.yaml\n"
    (tmp_path / "other.yaml").write_text(head + frame)
    other = build_edition(tmp_path / "other.yaml", tmp_path)
    check(other)
    sync = next(vector for vector in other.vectors if vector.name == "sync")
    assert sync.frame is not None
    assert (sync.frame[:3], sync.frame[-1]) == (b"\xff\xff\xfe", 0x58 ^ 0xFF)


def test_bits_that_are_set_are_named_in_texts(package: Any) -> None:
    used = codecs.load(package("feetech").TABLE)
    for error, named in ((0, "()"), (0x20, "(overload)"), (0x21, "(voltage, overload)")):
        status = used.table.frame.enclose(0, bytes([error]), 3, "reply")
        text = format_message(used.decode("reply", status))
        assert text == f"-> ping(errors={named}) from address 3"
