"""Each rule for clients: a session that breaks it, and right sessions that break none."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import strategies
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.client import MISDEEDS, Manners, Referee, Told
from cobotwire.conformance.client.rules import RULES
from cobotwire.conformance.client.script import RULES as SCRIPT_RULES
from cobotwire.conformance.report import Report, Verdict
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.sim.clock import SteppedClock

CODEC = ReferenceCodec(TABLE)
PAUSE = 1.2
# Seconds since the write before, and what is written.
Writes = Sequence[tuple[float, bytes]]

ANGLES = bytes.fromhex("FEFE0220FA")
POWERED = bytes.fromhex("FEFE0212FA")
COLOUR = bytes.fromhex("FEFE056A0102FAFA")
JOG = CODEC.encode("jog_increment", "request", (1, 10.0, 50))
OFF = bytes.fromhex("FEFE0211FA")
WIRELESS = bytes.fromhex("FEFE02B0FA")


def judged(
    writes: Writes,
    told: Sequence[Told] | None = None,
    misdeeds: Sequence[str] = (),
    every: int = 1,
    acks: bool = True,
) -> Report:
    clock = SteppedClock()
    manners = Manners(0.008, misdeeds, every)
    referee = Referee(TABLE, manners=manners, script=told, acks=acks, clock=clock)
    for after, data in [*writes, (PAUSE, b"")]:
        end = clock() + after
        while referee.wait is not None and clock() + referee.wait <= end:
            clock.sleep(referee.wait)
            referee.flush()
        clock.sleep(end - clock())
        if data:
            referee.receive(data)
    return referee.finish()


def broken(report: Report) -> set[str]:
    return {result.rule for result in report.results if result.verdict is Verdict.FAIL}


def spaced(*frames: bytes) -> Writes:
    return [(PAUSE, frame) for frame in frames]


def told(name: str, *values: object) -> Told:
    return Told(TABLE.command(name), values, "line 1")


BREAKING: dict[str, tuple[Writes, Sequence[str]]] = {
    "frame-length": (spaced(bytes.fromhex("FEFE0320FA")), ()),
    "frame-id": (spaced(bytes.fromhex("FEFE0299FA")), ()),
    "frame-footer": (spaced(bytes.fromhex("FEFE0220FB")), ()),
    "frame-whole": (spaced(bytes.fromhex("FEFE0220")), ()),
    "stray-bytes": (spaced(ANGLES + b"\x00"), ()),
    "interleaved-write": (spaced(COLOUR[:5] + ANGLES + COLOUR[5:]), ()),
    "value-range": (spaced(bytes.fromhex("FEFE062101700032FA")), ()),
    "value-listed": (spaced(bytes.fromhex("FEFE036263FA")), ()),
    "reply-awaited": ([(PAUSE, ANGLES), (0.002, POWERED)], ()),
    "reply-given-time": ([(PAUSE, ANGLES), (0.002, ANGLES)], ()),
    "late-reply-expected": (
        [(PAUSE, bytes.fromhex("FEFE033B01FA")), (0.4, bytes.fromhex("FEFE033B02FA"))],
        ("lost",),
    ),
    "motion-resent": ([(PAUSE, JOG), (0.5, JOG)], ("lost",)),
    "order-resent": ([(PAUSE, COLOUR), (0.5, COLOUR)], ("lost",)),
    "motion-powered": (spaced(OFF, JOG), ()),
    "text-follows": (spaced(WIRELESS, ANGLES), ()),
}


@pytest.mark.parametrize("rule", BREAKING)
def test_a_session_that_breaks_a_rule_is_found(rule: str) -> None:
    writes, misdeeds = BREAKING[rule]
    report = judged(writes, misdeeds=misdeeds)
    assert rule in broken(report)
    assert broken(report) <= {rule, "frame-footer", "stray-bytes"}, "and no innocent one"
    failure = next(r for r in report.results if r.rule == rule and r.verdict is Verdict.FAIL)
    assert failure.reason
    assert failure.evidence
    assert not report.conforms


def test_every_rule_has_its_session() -> None:
    # This edition's frames have no address byte.
    assert {rule.id for rule in RULES} == set(BREAKING) | {"frame-address"}


GIVEN: dict[str, tuple[Told, bytes]] = {
    "sent-scale": (
        told("send_angle", 1, 9.5, 30),
        CODEC.encode("send_angle", "request", (1, 95.0, 30)),
    ),
    "sent-sign": (
        told("send_angle", 1, 9.5, 30),
        CODEC.encode("send_angle", "request", (1, -9.5, 30)),
    ),
    "sent-byte-order": (
        told("send_angle", 1, 2.57 - 0.01, 30),
        CODEC.encode("send_angle", "request", (1, 0.01, 30)),
    ),
    "sent-order": (told("set_color", 1, 2, 3), CODEC.encode("set_color", "request", (3, 2, 1))),
    "sent-rounded": (
        told("send_angle", 1, -28.65, 30),
        CODEC.encode("send_angle", "request", (1, -28.64, 30)),
    ),
    "sent-value": (
        told("send_angle", 1, 9.5, 30),
        CODEC.encode("send_angle", "request", (1, 50.0, 30)),
    ),
    "sent-form": (
        told("send_coords", [1.0] * 6, 30),
        CODEC.encode("send_coords", "request", ([1.0] * 6, 30, 1)),
    ),
    "sent-once": (told("set_color", 1, 2, 3), CODEC.encode("set_color", "request", (1, 2, 3)) * 2),
    "sent-all": (told("stop"), b""),
    "sent-nothing-else": (told("set_color", 1, 2, 3), ANGLES),
}


@pytest.mark.parametrize("rule", SCRIPT_RULES)
def test_what_differs_from_the_script_is_named(rule: str) -> None:
    line, sent = GIVEN[rule]
    report = judged(spaced(POWERED, sent), [told("is_power_on"), line])
    assert rule in broken(report)
    assert broken(report) <= {rule, "sent-all", "order-resent"}


def test_without_a_script_it_says_what_it_cannot_judge() -> None:
    report = judged(spaced(ANGLES))
    unknown = {r.rule for r in report.results if r.verdict is Verdict.NOT_SUPPORTED}
    assert unknown == set(SCRIPT_RULES)
    assert report.conforms


REQUESTS = [form for form in strategies.forms_of(TABLE) if form.direction == "request"]
CALLS = st.lists(
    st.sampled_from([form for form in REQUESTS if form.command.request_text is None]).flatmap(
        lambda form: st.tuples(st.just(form), strategies.legal_values(form.layout))
    ),
    min_size=1,
    max_size=6,
    unique_by=lambda call: call[0].command.name,
)


@given(CALLS, st.sampled_from([*MISDEEDS, "good"]), st.booleans())
@settings(max_examples=60)
def test_a_client_that_does_what_it_is_told_is_never_found_guilty(
    calls: list[tuple[strategies.Form, tuple[object, ...]]], line: str, acks: bool
) -> None:
    calls = [call for call in calls if call[0].command.safety != "power"]
    frames = [strategies.frame_of(CODEC, form, values) for form, values in calls]
    script = [
        Told(form.command, values, "a line")
        for (form, values), frame in zip(calls, frames)
        if CODEC.encode(form.command.name, "request", values) == frame
    ]
    misdeeds = () if line == "good" else (line,)
    if len(script) < len(frames):
        assert not broken(judged(spaced(*frames), None, misdeeds, acks=acks))
    else:
        assert not broken(judged(spaced(*frames), script, misdeeds, acks=acks))


@given(st.sampled_from(sorted(BREAKING)), st.integers(1, 6))
def test_how_a_write_is_cut_does_not_matter(rule: str, size: int) -> None:
    writes, misdeeds = BREAKING[rule]
    cut = [
        (after if at == 0 else 0.0, data[at : at + size])
        for after, data in writes
        for at in range(0, len(data), size)
    ]
    assert rule in broken(judged(cut, misdeeds=misdeeds))


def test_a_query_may_be_asked_again_and_an_order_may_overtake() -> None:
    stop = CODEC.encode("stop", "request", ())
    assert not broken(judged([(PAUSE, ANGLES), (0.1, ANGLES), (0.002, stop)], misdeeds=("lost",)))


def test_an_order_that_was_acknowledged_may_be_wanted_again() -> None:
    assert not broken(judged([(PAUSE, JOG), (0.5, JOG)]))


def test_echoes_tell_late_replies_apart() -> None:
    asked = [bytes.fromhex(f"FEFE034A{joint}FA") for joint in ("01", "02")]
    sure = all(
        any(f.echo for f in form.fields) for form in TABLE.command("get_joint_min_angle").reply
    )
    report = judged([(PAUSE, asked[0]), (0.4, asked[1])], misdeeds=("lost",))
    assert ("late-reply-expected" in broken(report)) is not sure
