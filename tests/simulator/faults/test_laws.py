"""Test laws for any faults and requests: repeatable, and every changed byte is reported."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from hypothesis import example, given
from hypothesis import strategies as st

from cobotwire.simulator.faults import (
    KINDS,
    AppliedFault,
    Corrupted,
    Echo,
    Fault,
    Late,
    Merged,
    Silent,
    Slow,
    Split,
    Stalled,
)
from cobotwire.simulator.faults.noise import LEAKS
from faulty_talk import GET_ANGLES, IS_POWERED, POWER_ON, talk

SECONDS = st.sampled_from([0.0, 0.005, 0.1, 0.3, 1.0])
# Strategies for the fields of faults, by name; other fields keep their defaults.
FIELDS: dict[str, st.SearchStrategy[Any]] = {
    "only": st.sampled_from(["requests", "replies", "acknowledgements", "malformed input"]),
    "nth": st.lists(st.integers(1, 5), max_size=2).map(tuple),
    "every": st.integers(1, 3),
    "probability": st.sampled_from([0.0, 0.3, 0.7, 1.0]),
    "from_seconds": SECONDS,
    "commands": st.sampled_from([(), (0x12,), ("get_angles", "power_on")]),
    "of": st.sampled_from(["reply", "request"]),
    "seconds": SECONDS,
    "after_bytes": st.integers(1, 20),
    "where": st.sampled_from(["before", "inside", "after"]),
    "classes": st.sampled_from([("servo", "nuls"), ("panic",), ()]),
    "first": st.none() | st.integers(1, 3),
    "packets": st.sampled_from([("ping",), tuple(LEAKS)]),
    "byte": st.integers(0, 17),
    "times": st.integers(1, 3),
    "jitter_seconds": SECONDS,
    "deaf_seconds": SECONDS,
}
# Nothing can be sent after the port disappears.
LASTING = sorted(set(KINDS) - {"unplugged"})
TIMES = (Late, Stalled, Split, Slow, Merged)
REQUESTS = st.lists(
    st.sampled_from([IS_POWERED, GET_ANGLES, POWER_ON])
    | st.sampled_from([IS_POWERED + POWER_ON, b"\xfe\xfe\x02", b"abc", b"\xfe\xfe\x02\x19\xfa"])
    | st.sampled_from([0.01, 0.25, 1.0]),
    max_size=8,
)


@st.composite
def faults(draw: st.DrawFn, names: list[str] = LASTING) -> Fault:
    cls = KINDS[draw(st.sampled_from(names))]
    known = [name for name in cls.__dataclass_fields__ if name in FIELDS]
    chosen = draw(st.lists(st.sampled_from(known), max_size=4, unique=True))
    return cls(**{name: draw(FIELDS[name]) for name in chosen})


def _without_deaf(done: list[AppliedFault]) -> list[AppliedFault]:
    return [one for one in done if one.fault != "deaf"]


SEEDS = st.integers(0, 99)


@given(st.lists(faults(), max_size=4), REQUESTS, SEEDS)
def test_same_seed_and_requests_give_the_same_bytes_at_the_same_times(
    chosen: list[Fault], requests: list[bytes | float], seed: int
) -> None:
    assert talk(chosen, requests, seed=seed) == talk(chosen, requests, seed=seed)


@given(st.lists(faults(), max_size=4), REQUESTS, SEEDS)
def test_fault_with_probability_0_changes_nothing(
    chosen: list[Fault], requests: list[bytes | float], seed: int
) -> None:
    never = [replace(fault, probability=0) for fault in chosen]
    played = talk(never, requests, seed=seed)
    assert played == talk([], requests)
    assert played.applied == []
    assert played.data == b"".join(played.sent)


@given(st.lists(faults(), max_size=4), REQUESTS, SEEDS)
@example([Echo(), Silent()], [IS_POWERED], 0)  # the arm is silent after the echo was added
def test_reported_faults_account_for_every_byte(
    chosen: list[Fault], requests: list[bytes | float], seed: int
) -> None:
    played = talk(chosen, requests, seed=seed)
    added = sum(done.added for done in played.applied)
    assert len(played.data) == sum(map(len, played.sent)) + added


@given(
    faults(["merged", "duplicated", "silent", "panic"]), st.sampled_from([0.0, 0.01, 3.0]), SEEDS
)
def test_reported_faults_account_for_bytes_beside_a_reply(
    fault: Fault, pause: float, seed: int
) -> None:
    always = replace(fault, only="requests", commands=(), nth=(), every=2, probability=1)
    requests: list[bytes | float] = [GET_ANGLES, pause, IS_POWERED, pause, POWER_ON, pause] * 2
    played = talk([Late(seconds=0.005), always], requests, seed=seed)
    added = sum(done.added for done in played.applied)
    assert len(played.data) == sum(map(len, played.sent)) + added


def test_another_seed_changes_the_received_bytes() -> None:
    talks = [talk([Corrupted()], [GET_ANGLES] * 4, seed=seed).data for seed in range(5)]
    assert len(set(talks)) == 5


@given(faults([cls.kind for cls in TIMES]), REQUESTS, SEEDS)
def test_fault_of_time_loses_no_byte_and_mixes_no_replies(
    fault: Fault, requests: list[bytes | float], seed: int
) -> None:
    played = talk([fault], requests, seed=seed)
    if not isinstance(fault, Late):
        assert played.data == b"".join(played.sent)
    rest = played.data
    for reply in sorted(played.sent, key=len, reverse=True):
        assert reply in rest
        rest = rest.replace(reply, b"", 1)
    assert rest == b""


@given(faults(), REQUESTS, SEEDS)
def test_fault_that_changes_bytes_is_reported(
    fault: Fault, requests: list[bytes | float], seed: int
) -> None:
    played = talk([fault], requests, seed=seed)
    if not played.applied:
        assert played == talk([], requests)


def _shows_the_cut(fault: Fault) -> bool:
    """Return whether a fault reveals how malformed input was cut, because it echoes each piece."""
    return isinstance(fault, Echo) and fault.only == "malformed input"


@given(st.lists(faults(), max_size=3), REQUESTS, SEEDS, st.integers(1, 4))
def test_result_does_not_depend_on_how_requests_are_cut(
    chosen: list[Fault], requests: list[bytes | float], seed: int, size: int
) -> None:
    chosen = [fault for fault in chosen if not _shows_the_cut(fault)]
    whole = talk(chosen, requests, seed=seed)
    cut = talk(chosen, requests, seed=seed, size=size)
    assert (cut.received, cut.sent) == (whole.received, whole.sent)
    # A deaf arm misses single pieces, so its report depends on the cut.
    assert _without_deaf(cut.applied) == _without_deaf(whole.applied)


@given(st.lists(faults(), max_size=3), faults(), REQUESTS)
def test_further_fault_does_not_change_when_a_fault_is_applied(
    chosen: list[Fault], other: Fault, requests: list[bytes | float]
) -> None:
    # This holds if the further fault removes no request.
    harmless = Split(seconds=0, probability=0.5)
    with_it = [one for one in talk([*chosen, harmless], requests).applied if one.fault != "split"]
    without = [one for one in talk(chosen, requests).applied if one.fault != "split"]
    assert [(one.at, one.fault, one.request) for one in with_it] == [
        (one.at, one.fault, one.request) for one in without
    ]
