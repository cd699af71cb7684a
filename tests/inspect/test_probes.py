"""Probes in the frames of other editions do no harm: an arm reads them as queries or noise."""

from __future__ import annotations

from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.editions import load, names
from cobotwire.inspect.frame_families import families
from cobotwire.inspect.identification import identify_on, newest_first
from cobotwire.protocol.errors import ProtocolError
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock
from memory_peer import MemoryPeer
from request_parsers import PARSERS, Parser


@pytest.fixture(scope="module")
def probes() -> list[bytes]:
    """Return what an arm that never replies receives, write by write."""
    peer = MemoryPeer()
    found = identify_on(MemoryTransport(peer, SteppedClock()), timeout=0.3)
    assert (found.edition, found.candidates, found.replied) == ("", (), False)
    assert len(found.evidence) >= len(families(newest_first())) > 1
    return peer.writes


@pytest.mark.parametrize("parser", PARSERS, ids=lambda parser: parser.__name__)
def test_every_edition_finds_only_queries_in_all_probes(
    probes: list[bytes], parser: Parser
) -> None:
    for edition in names():
        codec = codecs.load(load(edition).TABLE, "reference")
        for last in range(1, len(probes) + 1):
            for frame in parser(codec, b"".join(probes[:last])):
                try:
                    command = codec.decode("request", frame).command
                except ProtocolError:
                    continue
                assert command.safety == "query", (edition, command.name)


@pytest.mark.parametrize("parser", PARSERS, ids=lambda parser: parser.__name__)
def test_every_edition_finds_its_own_probe_at_the_first_attempt(
    probes: list[bytes], parser: Parser
) -> None:
    for edition in names():
        table = load(edition).TABLE
        if table.find_role("powered") is None:
            continue
        codec = codecs.load(table, "reference")
        own = codec.encode(table.in_role("powered").name, "request", ())
        first = probes.index(own)
        assert parser(codec, b"".join(probes[: first + 1]))[-1:] == [own], edition


@pytest.mark.parametrize("edition", [n for n in names() if load(n).TABLE.find_role("powered")])
def test_arm_that_was_probed_before_executes_the_next_request(
    probes: list[bytes], edition: str
) -> None:
    clock = SteppedClock()
    arm = SimulatedArm(load(edition).TABLE, clock=clock)
    for probe in probes:
        arm.receive(probe)
    before = arm.state.powered
    client: Any = load(edition).CLIENT(MemoryTransport(arm, clock))
    client.power_on()
    assert (before, arm.state.powered) == (False, True)


def test_families_are_the_frame_formats_of_the_editions() -> None:
    groups = families(newest_first())
    assert sorted(name for group in groups for name in group) == sorted(names())
    assert {"mycobot", "mycobot280"} <= set(groups[0])
    assert ["mybuddy"] in groups
