"""What holds for any faults and requests: repeatable, accounted for, and nothing for nothing."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from cobotwire.sim.faults import (
    KINDS,
    Corrupted,
    Done,
    Echo,
    Fault,
    Late,
    Merged,
    Slow,
    Split,
    Stalled,
)
from cobotwire.sim.faults.noise import LEAKS
from faulty_talk import GET_ANGLES, IS_POWERED, POWER_ON, talk

SECONDS = st.sampled_from([0.0, 0.005, 0.1, 0.3, 1.0])
# What the fields of faults may hold, by name; the rest is left as it is.
FIELDS: dict[str, st.SearchStrategy[Any]] = {
    "only": st.sampled_from(["requests", "answers", "acknowledgements", "malformed input"]),
    "nth": st.lists(st.integers(1, 5), max_size=2).map(tuple),
    "every": st.integers(1, 3),
    "probability": st.sampled_from([0.0, 0.3, 0.7, 1.0]),
    "from_seconds": SECONDS,
    "commands": st.sampled_from([(), (0x12,), ("get_angles", "power_on")]),
    "of": st.sampled_from(["reply", "request"]),
    "seconds": SECONDS,
    "after_bytes": st.integers(1, 20),
    "where": st.sampled_from(["in front", "inside", "behind"]),
    "packets": st.sampled_from([("ping",), tuple(LEAKS)]),
    "byte": st.integers(0, 17),
    "times": st.integers(1, 3),
    "jitter_seconds": SECONDS,
    "deaf_seconds": SECONDS,
}
# A port that goes ends the talk.
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


def _without_deaf(done: list[Done]) -> list[Done]:
    return [one for one in done if one.fault != "deaf"]


SEEDS = st.integers(0, 99)


@given(st.lists(faults(), max_size=4), REQUESTS, SEEDS)
def test_the_same_seed_and_the_same_requests_give_the_same_bytes_at_the_same_times(
    chosen: list[Fault], requests: list[bytes | float], seed: int
) -> None:
    assert talk(chosen, requests, seed=seed) == talk(chosen, requests, seed=seed)


@given(st.lists(faults(), max_size=4), REQUESTS, SEEDS)
def test_a_fault_that_is_never_done_leaves_the_peer_as_it_is(
    chosen: list[Fault], requests: list[bytes | float], seed: int
) -> None:
    never = [replace(fault, probability=0) for fault in chosen]
    played = talk(never, requests, seed=seed)
    assert played == talk([], requests)
    assert played.done == []
    assert played.data == b"".join(played.said)


@given(st.lists(faults(), max_size=4), REQUESTS, SEEDS)
def test_every_byte_is_accounted_for(
    chosen: list[Fault], requests: list[bytes | float], seed: int
) -> None:
    played = talk(chosen, requests, seed=seed)
    added = sum(done.added for done in played.done)
    assert len(played.data) == sum(map(len, played.said)) + added


@given(faults(["merged", "doubled", "silent", "panic"]), st.sampled_from([0.0, 0.01, 3.0]), SEEDS)
def test_what_goes_beside_a_reply_is_accounted_for(fault: Fault, pause: float, seed: int) -> None:
    always = replace(fault, only="requests", commands=(), nth=(), every=2, probability=1)
    requests: list[bytes | float] = [GET_ANGLES, pause, IS_POWERED, pause, POWER_ON, pause] * 2
    played = talk([Late(seconds=0.005), always], requests, seed=seed)
    added = sum(done.added for done in played.done)
    assert len(played.data) == sum(map(len, played.said)) + added


def test_another_seed_draws_otherwise() -> None:
    talks = [talk([Corrupted()], [GET_ANGLES] * 4, seed=seed).data for seed in range(5)]
    assert len(set(talks)) == 5


@given(faults([cls.kind for cls in TIMES]), REQUESTS, SEEDS)
def test_a_fault_of_time_loses_no_byte_and_mixes_no_replies(
    fault: Fault, requests: list[bytes | float], seed: int
) -> None:
    played = talk([fault], requests, seed=seed)
    if not isinstance(fault, Late):
        assert played.data == b"".join(played.said)
    rest = played.data
    for reply in sorted(played.said, key=len, reverse=True):
        assert reply in rest
        rest = rest.replace(reply, b"", 1)
    assert rest == b""


@given(faults(), REQUESTS, SEEDS)
def test_what_is_not_told_was_not_done(
    fault: Fault, requests: list[bytes | float], seed: int
) -> None:
    played = talk([fault], requests, seed=seed)
    if not played.done:
        assert played == talk([], requests)


def _shows_the_cut(fault: Fault) -> bool:
    """What is no request has no end to wait for: a line that echoes it does so as it comes."""
    return isinstance(fault, Echo) and fault.only == "malformed input"


@given(st.lists(faults(), max_size=3), REQUESTS, SEEDS, st.integers(1, 4))
def test_how_the_requests_were_cut_does_not_show(
    chosen: list[Fault], requests: list[bytes | float], seed: int, size: int
) -> None:
    chosen = [fault for fault in chosen if not _shows_the_cut(fault)]
    whole = talk(chosen, requests, seed=seed)
    cut = talk(chosen, requests, seed=seed, size=size)
    assert (cut.heard, cut.said) == (whole.heard, whole.said)
    # What a deaf arm misses, it misses piece by piece.
    assert _without_deaf(cut.done) == _without_deaf(whole.done)


@given(st.lists(faults(), max_size=3), faults(), REQUESTS)
def test_another_fault_behind_it_does_not_change_when_a_fault_is_done(
    chosen: list[Fault], other: Fault, requests: list[bytes | float]
) -> None:
    # As long as the other one takes no request away.
    harmless = Split(seconds=0, probability=0.5)
    with_it = [one for one in talk([*chosen, harmless], requests).done if one.fault != "split"]
    without = [one for one in talk(chosen, requests).done if one.fault != "split"]
    assert [(one.at, one.fault, one.request) for one in with_it] == [
        (one.at, one.fault, one.request) for one in without
    ]
