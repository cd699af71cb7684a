"""Recognise firmware messages, panics and reboots as seen in the field, and describe them."""

from __future__ import annotations

import pytest

from cobotwire.codec.interface import Codec, Frame
from cobotwire.diagnose import (
    CommandError,
    Finding,
    Garbage,
    Nuls,
    Panic,
    Text,
    summarize,
)
from cobotwire.simulator.faults import noise
from diagnosing import FRAME, PING, READ, STATUS, diagnose, kinds, only


def test_repeated_cmd_len_error_is_a_finding_each_time(codec: Codec) -> None:
    for end in (b"\r\n", b"\n", b""):
        items = diagnose(codec, (b"cmd_len error" + end) * 5)
        assert kinds(items) == [CommandError] * 5
    both = diagnose(codec, b"cmd_len error\r\n" + FRAME + b"cmd_len error\r\n")
    assert kinds(both) == [CommandError, Frame, CommandError]


def test_panic_has_its_cause_core_and_addresses(codec: Codec) -> None:
    panic = only(codec, noise.PANIC)
    assert isinstance(panic, Panic)
    assert (panic.core, panic.cause, panic.rebooting) == (1, "LoadProhibited", True)
    assert (panic.pc, panic.address) == (0x400D15F4, 4)
    assert panic.backtrace == (0x400D15F1, 0x400D0B59, 0x40088B9D)


def test_short_panic_of_the_field_notes_is_recognised(codec: Codec) -> None:
    panic = only(codec, b"Guru Meditation Error: Core 1 panic'ed (LoadProhibited)...")
    assert isinstance(panic, Panic)
    assert (panic.core, panic.cause, panic.rebooting) == (1, "LoadProhibited", False)
    assert summarize([panic]) == "the controller failed: panic LoadProhibited"


def test_panic_of_older_firmware_is_recognised(codec: Codec) -> None:
    text = b"Guru Meditation Error of type StoreProhibited occurred on core  0. Exception was\r\n"
    panic = only(codec, text)
    assert isinstance(panic, Panic)
    assert (panic.core, panic.cause) == (0, "StoreProhibited")


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


def test_two_panics_without_a_reboot_are_two_findings(codec: Codec) -> None:
    half = noise.PANIC[:150]
    items = diagnose(codec, half + noise.PANIC)
    assert [item.data for item in items] == [half, noise.PANIC]
    assert all(isinstance(item, Panic) for item in items)


def test_crash_is_recognised_from_the_error_to_the_boot(codec: Codec) -> None:
    garbage = bytes.fromhex("78 80 78")
    stream = FRAME + b"cmd_len error\r\n" * 2 + noise.PANIC + bytes(277) + garbage + FRAME
    items = diagnose(codec, stream)
    assert kinds(items) == [Frame, CommandError, CommandError, Panic, Nuls, Garbage, Frame]
    sentence = summarize([item for item in items if isinstance(item, Finding)])
    assert sentence.startswith("the controller rebooted: panic LoadProhibited; ")
    assert "cmd_len error 2 times" in sentence


@pytest.mark.parametrize(("count", "reboot"), [(1, False), (17, False), (63, False), (277, True)])
def test_many_nuls_are_a_reboot(codec: Codec, count: int, reboot: bool) -> None:
    nuls = only(codec, bytes(count))
    assert isinstance(nuls, Nuls)
    assert (nuls.count, nuls.reboot) == (count, reboot)


def test_very_many_nuls_are_one_reboot_in_pieces(codec: Codec) -> None:
    items = [item for item in diagnose(codec, bytes(100_000)) if isinstance(item, Nuls)]
    assert sum(item.count for item in items) == 100_000
    assert [item.continued for item in items] == [False] + [True] * (len(items) - 1)
    assert summarize(items) == "the controller rebooted"


def test_text_is_split_into_lines_and_continues_after_a_frame(codec: Codec) -> None:
    items = diagnose(codec, b"ets Jul 29 2019\r\nok\r\nload:0x3fff" + FRAME + b"0030,len:4\r\n")
    texts = [item.text for item in items if isinstance(item, Text)]
    assert texts == ["ets Jul 29 2019\r\n", "ok\r\n", "load:0x3fff0030,len:4\r\n"]


@pytest.mark.parametrize("line", noise.LOG)
def test_line_of_the_log_is_text_and_no_failure(codec: Codec, line: bytes) -> None:
    text = only(codec, line)
    assert isinstance(text, Text)
    assert text.text.encode() == line
    assert summarize([text]).startswith("text: ")


def test_boot_line_has_its_cause(codec: Codec) -> None:
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
    assert summarize([]) == ""
