"""``reconcile`` finds exactly the frames of a capture that the edition lacks."""

from __future__ import annotations

import json
import math
import random
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import vectors
from cobotwire.capture.packet import Interface, Packet
from cobotwire.capture.writer import CaptureWriter
from cobotwire_codegen.author.guess import guess
from cobotwire_codegen.author.reconcile import News, captured, draft_lines, reconcile
from cobotwire_codegen.author.scan import known_variants, scan
from cobotwire_codegen.build import build_edition
from codegen.author import samples

EDITION = build_edition(vectors.ROOT / "spec/editions/mycobot.yaml", vectors.ROOT)
KNOWN = known_variants(EDITION, "both")
FRAMES = [vector.frame for vector in EDITION.vectors if vector.frame is not None]


def _reconciled(line: bytes, direction: str = "both") -> tuple[int, list[News]]:
    return reconcile(EDITION, captured(line, direction))


def _frame(id: int, data: bytes) -> bytes:
    return bytes([0xFE, 0xFE, len(data) + 2, id, *data, 0xFA])


def test_scan_finds_every_frame_of_the_vectors() -> None:
    line = b"".join(FRAMES)
    assert [seen.frame for seen in scan(EDITION, line, KNOWN)] == FRAMES
    assert _reconciled(line) == (len(FRAMES), [])


# The bytes 02 82 FA inside this unknown frame are a known frame that lacks its header.
@example(data=b"\x02\x82", count=1)
@given(data=st.binary(max_size=16), count=st.integers(1, 5))
def test_reconcile_finds_an_unknown_id_between_known_frames(data: bytes, count: int) -> None:
    unknown = _frame(0xEE, data)
    line = b"".join([FRAMES[3] + unknown] * count)
    found = _reconciled(line)[1]
    inside = any(seen.offset for seen in scan(EDITION, unknown, KNOWN))
    assert inside or [(n.id, n.data_bytes, len(n.frames)) for n in found] == [
        (0xEE, len(data), count)
    ]


@given(line=st.binary(max_size=200), more=st.lists(st.sampled_from(FRAMES), max_size=5))
def test_scan_yields_valid_frames_without_overlap(line: bytes, more: list[bytes]) -> None:
    end = 0
    whole = line + b"".join(more)
    for seen in scan(EDITION, whole, KNOWN):
        assert seen.offset >= end
        end = seen.offset + len(seen.frame)
        assert whole[seen.offset : end] == seen.frame == _frame(seen.id, seen.data)


def test_reconcile_reports_a_known_id_with_an_unknown_length() -> None:
    [news] = _reconciled(_frame(0x20, b"\x01"))[1]
    assert news.why == "get_angles has no message of this length"


def test_reconcile_knows_only_messages_of_the_given_direction() -> None:
    reply = next(v.frame for v in EDITION.vectors if v.command == "get_angles" and v.values)
    assert reply is not None
    assert _reconciled(reply, "reply")[1] == []
    assert len(_reconciled(reply, "request")[1]) == 1


def _payloads() -> list[bytes]:
    random.seed(1)
    made = []
    for i in range(40):
        word = int(9000 * math.sin(i / 15)) & 0xFFFF
        wild = random.choice((3, 60, 200))
        made.append(bytes([i, i % 2, *word.to_bytes(2, "big"), 7, i * i % 5, wild, *b"mk2 fw1"]))
    return made


def test_guess_recognizes_kinds_of_bytes() -> None:
    found = [(item.first, item.kind) for item in guess(_payloads())]
    kinds = ["counter", "flag", "word", "constant", "enum", "byte", "text"]
    assert found == list(zip((0, 1, 2, 4, 5, 6, 7), kinds))


def test_reconcile_prints_drafts_and_exits_with_1() -> None:
    line = b"".join(_frame(0xEE, payload) for payload in _payloads()).hex(" ")
    result = samples.run(vectors.ROOT, "reconcile", "-", given=line)
    assert result.returncode == 1
    assert "# GUESSED from 40 frame(s); the id is unknown." in result.stdout
    assert "; fits measured_angle: 0..89.96 degree, scale 1/100, signed" in result.stdout
    assert "40 frame(s), 1 unknown variant(s)" in result.stderr
    known = samples.run(vectors.ROOT, "reconcile", "-", given=b"".join(FRAMES))
    assert (known.returncode, known.stdout) == (0, "")


def test_drafts_have_the_types_that_values_fit_and_the_effects_that_pairs_show() -> None:
    line = b""
    for i in range(20):
        word = int(9000 * math.sin(i / 5)).to_bytes(2, "big", signed=True)
        # Angles, a message that repeats the first angle, and a setting that is read back.
        line += _frame(0x20, word * 6) + _frame(0xEE, word + bytes([i % 2, 20 + 3 * i]))
        line += _frame(0xEA, bytes([7 * i])) + _frame(0xEB, b"") + _frame(0xEB, bytes([7 * i]))
    _, found = _reconciled(line)
    shown = ["\n".join(draft_lines(EDITION, news)) for news in found]
    stored, _, reported, measured = shown
    assert "equals get_angles.angles[0]: -55.06..89.96 degree, scale 1/100, signed" in measured
    assert "{name: flag_2, type: flag}" in measured
    assert "type: speed}  # guess: 20..77; fits speed: 20..77 percent" in measured
    assert "    stores:\n      byte_0: state_ea_0" in stored
    assert "safety: query  # its values are always those that 0xEA has set" in reported
    assert "    reports:\n      byte_0: state_ea_0" in reported


def test_scan_finds_frames_with_address_and_sum() -> None:
    line = bytes.fromhex("FE FE 01 03 70 01 71  FE FE 01 03 70 01 72  FE FE 09 03 70 01 71")
    result = samples.run(samples.FOLDER, "reconcile", "-", "--edition", "bus.yaml", given=line)
    assert "21 bytes, 1 frame(s), 1 unknown variant(s)" in result.stderr


def test_capture_is_read_as_raw_bytes_or_hex_text() -> None:
    [packet] = captured(b"fe FE\n0x02, 0x10 fa", "both")
    assert packet.data == bytes.fromhex("FE FE 02 10 FA")
    assert captured(FRAMES[0], "reply") == [(0, "reply", FRAMES[0])]
    with pytest.raises(ValueError, match="hex"):
        captured(b"FE F", "both")
    assert samples.run(vectors.ROOT, "reconcile", "-", given="FE F").returncode == 2


def test_directions_of_a_recording_distinguish_requests_from_replies(tmp_path: Path) -> None:
    path = tmp_path / "arm.pcapng"
    with path.open("wb") as file:
        writer = CaptureWriter(file)
        arms = [writer.interface(Interface(url)) for url in ("/dev/ttyUSB0", "/dev/ttyUSB1")]
        for i in range(20):
            value, torn = bytes([7 * i]), _frame(0xE8, bytes([i, 3]))
            sent = _frame(0xEA, value) + _frame(0xEB, b"") + _frame(0x20, b"")
            writer.packet(Packet(i, "sent", sent, "bytes", interface=arms[0]))
            # A reply of the other arm arrives between the two parts of this arm's reply.
            replies = torn[:3], _frame(0xE9, b"\1"), torn[3:] + _frame(0xEB, value)
            for arm, data in zip((arms[0], arms[1], arms[0]), replies):
                writer.packet(Packet(i, "received", data, "bytes", interface=arm))
        writer.finish()
    result = samples.run(vectors.ROOT, "reconcile", str(path), "--json")
    found = {(u["id"], u["direction"]): u for u in json.loads(result.stdout)["unknown"]}
    assert [(*key, each["count"]) for key, each in found.items()] == [
        *((0xE8, "reply", 20), (0xE9, "reply", 20), (0xEA, "request", 20)),
        *((0xEB, "request", 20), (0xEB, "reply", 20)),
    ]
    assert found[0xE8, "reply"]["offsets"][0] == 16
    assert "  reply:\n" in found[0xE8, "reply"]["draft"]
    assert "  request:\n" in found[0xEA, "request"]["draft"]
    assert "safety: query" in found[0xEB, "reply"]["draft"]
