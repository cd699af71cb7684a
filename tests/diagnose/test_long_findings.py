"""Recognise findings that span several items or are truncated, and summarize them."""

from __future__ import annotations

import pytest

from cobotwire.codec.interface import Codec, Frame
from cobotwire.diagnose import (
    CommandError,
    DamagedFrame,
    Diagnoser,
    Finding,
    Garbage,
    Nuls,
    Panic,
    ServoPacket,
    summarize,
)
from cobotwire.simulator.faults import noise
from diagnosing import FRAME, PING, READ, STATUS, diagnose, kinds, only


@pytest.mark.parametrize("cut", [5, 30, 60, 200, 300])
def test_panic_is_recognised_despite_a_frame_or_damaged_bytes_inside(
    codec: Codec, cut: int
) -> None:
    for inside in (FRAME, b"\xfe\xff\x80"):
        stream = noise.PANIC[:cut] + inside + noise.PANIC[cut:]
        panics = [item for item in diagnose(codec, stream) if isinstance(item, Panic)]
        if inside != FRAME and cut < 21:
            assert not panics, "the words that identify a panic are damaged"
            continue
        assert len(panics) == 1
        assert panics[0].rebooting
        assert panics[0].data.startswith(b"Guru")
        assert panics[0].data.endswith(b"Rebooting...\r\n")


def test_crash_is_recognised_from_the_error_to_the_boot(codec: Codec) -> None:
    garbage = bytes.fromhex("78 80 78")
    stream = FRAME + b"cmd_len error\r\n" * 2 + noise.PANIC + bytes(277) + garbage + FRAME
    items = diagnose(codec, stream)
    assert kinds(items) == [Frame, CommandError, CommandError, Panic, Nuls, Garbage, Frame]
    sentence = summarize([item for item in items if isinstance(item, Finding)])
    assert sentence.startswith("the controller rebooted: panic LoadProhibited; ")
    assert "cmd_len error 2 times" in sentence


def test_long_run_of_nuls_is_split_into_items_of_one_reboot(codec: Codec) -> None:
    items = [item for item in diagnose(codec, bytes(100_000)) if isinstance(item, Nuls)]
    assert sum(item.count for item in items) == 100_000
    assert [item.continued for item in items] == [False] + [True] * (len(items) - 1)
    assert summarize(items) == "the controller possibly rebooted"


def test_boot_line_is_described_by_its_cause(codec: Codec) -> None:
    boot = only(codec, b"rst:0xc (SW_CPU_RESET),boot:0x13 (SPI_FAST_FLASH_BOOT)\r\n")
    assert isinstance(boot, Finding)
    assert boot.describe() == "the controller boots: SW_CPU_RESET"


def test_findings_are_summarized_in_a_sentence(codec: Codec) -> None:
    findings = [i for i in diagnose(codec, READ + STATUS + PING) if isinstance(i, Finding)]
    assert summarize(findings) == (
        "servo bus leak: 3 packets, "
        "e.g. read 2 bytes at register 0x38 (present position) of servo 1"
    )
    findings = [i for i in diagnose(codec, noise.PANIC) if isinstance(i, Finding)]
    assert summarize(findings) == "the controller rebooted: panic LoadProhibited"
    short = only(codec, b"Guru Meditation Error: Core 1 panic'ed (LoadProhibited)...")
    assert isinstance(short, Panic)
    assert summarize([short]) == "the controller failed: panic LoadProhibited"
    text = only(codec, noise.LOG[0])
    assert isinstance(text, Finding)
    assert summarize([text]).startswith("text: ")
    assert summarize([]) == ""


def test_servo_packet_interrupted_by_many_frames_is_not_recognised(codec: Codec) -> None:
    items = diagnose(codec, READ[:5] + FRAME * 20 + READ[5:])
    assert not any(isinstance(item, ServoPacket) for item in items)


def test_frame_that_a_flush_cuts_in_two_is_damaged_and_not_an_echo(codec: Codec) -> None:
    framer, diagnoser = codec.framer("reply"), Diagnoser(codec)
    events = [*framer.feed(FRAME[:3]), *framer.flush(), *framer.feed(FRAME[3:]), *framer.flush()]
    (finding,) = diagnoser.feed(events) + diagnoser.flush()
    assert isinstance(finding, DamagedFrame)
    assert (finding.command, finding.reason, finding.data) == ("is_power_on", "truncated", FRAME)
