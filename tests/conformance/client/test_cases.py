"""Each test case for clients fails for one session and passes for correct sessions."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import strategies
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.client import (
    SUITE,
    Referee,
    ScriptLine,
    faulty_replies,
    possible_faults,
)
from cobotwire.conformance.client.script import SCRIPT
from cobotwire.conformance.report import Cause, Report
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator.clock import SteppedClock
from playing import play

SCRIPT_CASES = [case.id for case in SCRIPT.cases]
CODEC = ReferenceCodec(TABLE)
PAUSE = 1.2
# Seconds since the previous write, and the bytes written.
Writes = Sequence[tuple[float, bytes]]

ANGLES = bytes.fromhex("FEFE0220FA")
POWERED = bytes.fromhex("FEFE0212FA")
COLOUR = bytes.fromhex("FEFE056A0102FAFA")
JOG = CODEC.encode("jog_increment", "request", (1, 10.0, 50))
OFF = bytes.fromhex("FEFE0211FA")
WIRELESS = bytes.fromhex("FEFE02B0FA")


def checked(
    writes: Writes,
    script: Sequence[ScriptLine] | None = None,
    faults: Sequence[str] = (),
    every: int = 1,
    acks: bool = True,
) -> Report:
    clock = SteppedClock()
    scenario = faulty_replies(0.008, faults, every)
    referee = Referee(TABLE, scenario=scenario, script=script, acks=acks, clock=clock)
    play(referee, clock, [*writes, (PAUSE, b"")])
    return referee.finish()


def failed(report: Report) -> set[str]:
    return {result.case for result in report.failures}


def spaced(*frames: bytes) -> Writes:
    return [(PAUSE, frame) for frame in frames]


def line(name: str, *values: object) -> ScriptLine:
    return ScriptLine(TABLE.command(name), values, "line 1")


LOST = ("lost",)
# The faults of the line, the writes of the client, and a part of the reason.
FAILING: dict[str, tuple[Sequence[str], Writes, str]] = {
    "frame-length": (
        (),
        spaced(bytes.fromhex("FEFE032000FA")),
        "LEN is 03, but get_angles or get_radians has LEN 02: FE FE [LEN 03] [id 20] 00 FA",
    ),
    "frame-id": (
        (),
        spaced(bytes.fromhex("FEFE049A0102FA")),
        "no command with the id 9A: FE FE [LEN 04] [id 9A] 01 02 FA",
    ),
    "frame-footer": (
        (),
        spaced(bytes.fromhex("FEFE0220FB")),
        "the footer FA after 4 bytes: FE FE [LEN 02] [id 20] [foo",
    ),
    "frame-whole": (
        (),
        spaced(bytes.fromhex("FEFE062101")),
        "send_angle breaks off: LEN 06 requires 4 more bytes",
    ),
    "stray-bytes": ((), spaced(b"\x01\x02\x03"), "bytes outside any frame: 01 02 03"),
    "interleaved-write": ((), spaced(COLOUR[:5] + ANGLES + COLOUR[5:]), ""),
    "value-range": ((), spaced(bytes.fromhex("FEFE062101700032FA")), ""),
    "value-listed": ((), spaced(bytes.fromhex("FEFE036263FA")), ""),
    "reply-awaited": ((), [(PAUSE, ANGLES), (0.002, POWERED)], ""),
    "reply-given-time": ((), [(PAUSE, ANGLES), (0.002, ANGLES)], ""),
    "late-reply-expected": (
        LOST,
        [(PAUSE, bytes.fromhex("FEFE033B01FA")), (0.4, bytes.fromhex("FEFE033B02FA"))],
        "",
    ),
    "motion-resent": (LOST, [(PAUSE, JOG), (0.5, JOG)], ""),
    "change-resent": (LOST, [(PAUSE, COLOUR), (0.5, COLOUR)], ""),
    "motion-powered": ((), spaced(OFF, JOG), "switched off"),
    "text-follows": ((), spaced(WIRELESS, ANGLES), ""),
}


@pytest.mark.parametrize("case", FAILING)
def test_session_fails_the_test_case_that_it_violates(case: str) -> None:
    faults, writes, words = FAILING[case]
    report = checked(writes, faults=faults)
    assert failed(report) <= {case, "frame-footer", "stray-bytes"}, "and no other test case"
    [failure] = [result for result in report.failures if result.case == case]
    assert words in failure.reason != ""
    assert failure.evidence
    assert not report.conforms


def test_every_test_case_has_a_failing_session() -> None:
    # The frames of this edition have no address byte, and expected failures come from a file.
    expected = {*FAILING, *GIVEN, "frame-address", "sent-address", "expected-failure"}
    assert {case.id for case in SUITE.cases} == expected


GIVEN: dict[str, tuple[ScriptLine, bytes]] = {
    "sent-scale": (
        line("send_angle", 1, 9.5, 30),
        CODEC.encode("send_angle", "request", (1, 95.0, 30)),
    ),
    "sent-sign": (
        line("send_angle", 1, 9.5, 30),
        CODEC.encode("send_angle", "request", (1, -9.5, 30)),
    ),
    "sent-byte-order": (
        line("send_angle", 1, 2.57 - 0.01, 30),
        CODEC.encode("send_angle", "request", (1, 0.01, 30)),
    ),
    "sent-order": (line("set_color", 1, 2, 3), CODEC.encode("set_color", "request", (3, 2, 1))),
    "sent-rounded": (
        line("send_angle", 1, -28.65, 30),
        CODEC.encode("send_angle", "request", (1, -28.64, 30)),
    ),
    "sent-value": (
        line("send_angle", 1, 9.5, 30),
        CODEC.encode("send_angle", "request", (1, 50.0, 30)),
    ),
    "sent-variant": (
        line("send_coords", [1.0] * 6, 30),
        CODEC.encode("send_coords", "request", ([1.0] * 6, 30, 1)),
    ),
    "sent-once": (line("set_color", 1, 2, 3), CODEC.encode("set_color", "request", (1, 2, 3)) * 2),
    "sent-all": (line("stop"), b""),
    "sent-nothing-else": (line("set_color", 1, 2, 3), ANGLES),
}


# Frames of this edition have no address.
@pytest.mark.parametrize("case", [case for case in SCRIPT_CASES if case != "sent-address"])
def test_difference_from_the_script_is_named(case: str) -> None:
    scripted, sent = GIVEN[case]
    report = checked(spaced(POWERED, sent), [line("is_power_on"), scripted])
    assert case in failed(report)
    assert failed(report) <= {case, "sent-all", "change-resent"}


def test_script_cases_without_a_script_are_not_supported() -> None:
    report = checked(spaced(ANGLES))
    unknown = {r.case for r in report.results if r.cause is Cause.NOT_SELECTED}
    assert unknown == set(SCRIPT_CASES)
    assert report.conforms


REQUESTS = [variant for variant in strategies.variants_of(TABLE) if variant.direction == "request"]
CALLS = st.lists(
    st.sampled_from(
        [variant for variant in REQUESTS if variant.command.request_text is None]
    ).flatmap(
        lambda variant: st.tuples(st.just(variant), strategies.legal_values(variant.variant))
    ),
    min_size=1,
    max_size=6,
    unique_by=lambda call: call[0].command.name,
)


@given(CALLS, st.sampled_from([*possible_faults(TABLE), "good"]), st.booleans())
@settings(max_examples=60)
def test_client_that_sends_its_script_never_fails(
    calls: list[tuple[strategies.CommandVariant, tuple[object, ...]]], fault: str, acks: bool
) -> None:
    calls = [call for call in calls if call[0].command.safety != "power"]
    frames = [strategies.frame_of(CODEC, variant, values) for variant, values in calls]
    script = [
        ScriptLine(variant.command, values, "a line")
        for (variant, values), frame in zip(calls, frames)
        if CODEC.encode(variant.command.name, "request", values) == frame
    ]
    faults = () if fault == "good" else (fault,)
    if len(script) < len(frames):
        assert not failed(checked(spaced(*frames), None, faults, acks=acks))
    else:
        assert not failed(checked(spaced(*frames), script, faults, acks=acks))


@given(st.sampled_from(sorted(FAILING)), st.integers(1, 6))
def test_verdict_does_not_depend_on_the_chunks_of_a_write(case: str, size: int) -> None:
    faults, writes, _ = FAILING[case]
    cut = [
        (after if at == 0 else 0.0, data[at : at + size])
        for after, data in writes
        for at in range(0, len(data), size)
    ]
    assert case in failed(checked(cut, faults=faults))


def test_query_may_be_repeated_and_a_stop_may_overtake_it() -> None:
    stop = CODEC.encode("stop", "request", ())
    assert not failed(checked([(PAUSE, ANGLES), (0.1, ANGLES), (0.002, stop)], faults=("lost",)))


def test_acknowledged_change_may_be_sent_again() -> None:
    assert not failed(checked([(PAUSE, JOG), (0.5, JOG)]))
