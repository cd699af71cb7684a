"""Identify and connect on simulated arms of both editions, over a pty and over TCP."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

import cobotwire
from cobotwire import EditionUnknown, LinkError, MyCobot, MyCobot280, connect, identify
from cobotwire.client.port_memory import PortMemory
from cobotwire.editions import load, names
from cobotwire.inspect.identification import identify_on, own_query
from cobotwire.simulator import PtyServer, SimulatedArm, TcpServer
from cobotwire.transport import open_transport
from command_line import run_program
from scripted_peer import ScriptedPeer

POWERED = bytes.fromhex("FE FE 03 12 01 FA")
REQUESTS = {"mycobot280": "FEFE0212FA FEFE0202FA", "mycobot": "FEFE0212FA FEFE0202FA FEFE0240FA"}


@pytest.fixture(params=[(e, t) for e in ("mycobot", "mycobot280") for t in ("pty", "tcp")])
def arm(request: pytest.FixtureRequest) -> Iterator[tuple[str, str]]:
    """Serve a simulated arm; return its edition and its URL."""
    edition, transport = request.param
    simulated = SimulatedArm(load(edition).TABLE)
    with ExitStack() as stack:
        server = PtyServer(simulated) if transport == "pty" else TcpServer(simulated.connect)
        yield edition, stack.enter_context(server).url


def test_root_package_exports_the_client_of_todays_arm() -> None:
    assert cobotwire.MyCobot280 is load("mycobot280").CLIENT
    assert cobotwire.AsyncMyCobot280 is load("mycobot280").ASYNC_CLIENT


def test_own_query_of_each_edition_has_an_id_that_no_other_edition_has() -> None:
    found = {name: own_query(load(name).TABLE) for name in names()}
    assert {name: query and query.name for name, query in found.items()} == {
        "mycobot": "get_speed",
        "mycobot280": "get_system_version",
    }


def test_identify_recognises_edition_and_firmware_of_a_simulated_arm(arm: tuple[str, str]) -> None:
    edition, url = arm
    found = identify(url, timeout=0.3)
    assert (found.edition, found.url) == (edition, url)
    assert bool(found.firmware) == (edition == "mycobot280")
    assert found.evidence[-1].replied
    assert found.evidence[-1].edition == edition


def test_connect_returns_the_client_of_the_arms_edition(arm: tuple[str, str]) -> None:
    edition, url = arm
    with connect(url, timeout=0.3) as client:
        assert type(client) is {"mycobot": MyCobot, "mycobot280": MyCobot280}[edition]
        client.set_tool_reference([100, 0, 0, 0, 0, 0])
        assert client.get_tool_reference().x == 100
    with connect(url, timeout=0.3) as again:
        assert again.is_power_on() is False


def test_connect_async_returns_an_open_asyncio_client(arm: tuple[str, str]) -> None:
    edition, url = arm

    async def use() -> tuple[str, bool]:
        async with await cobotwire.connect_async(url, timeout=0.3) as client:
            return type(client).__name__, await client.is_power_on()

    name = {"mycobot": "AsyncMyCobot", "mycobot280": "AsyncMyCobot280"}[edition]
    assert asyncio.run(use()) == (name, False)


def test_connect_without_a_reply_or_a_decision_names_the_queries_and_closes_the_port() -> None:
    with ScriptedPeer() as peer:
        with pytest.raises(EditionUnknown, match=r"is_power_on: no reply\); .*MyCobot280"):
            connect(peer.url, timeout=0.1)
        MyCobot280(peer.url).close()
    with ScriptedPeer([POWERED]) as peer:
        with pytest.raises(EditionUnknown, match="get_system_version: no reply; get_speed: no rep"):
            connect(peer.url, timeout=0.1)
    with pytest.raises(LinkError):
        connect("/dev/nosuchport")


@pytest.mark.parametrize("edition", ["mycobot", "mycobot280"])
def test_identify_sends_nothing_but_its_harmless_queries(edition: str) -> None:
    own = {"mycobot280": "FE FE 03 02 49 FA", "mycobot": "FE FE 03 40 32 FA"}[edition]
    silent: list[list[bytes]] = [] if edition == "mycobot280" else [[]]
    with ScriptedPeer([POWERED], *silent, [bytes.fromhex(own)]) as peer:
        assert identify(peer.url, timeout=0.15).edition == edition
        received = {peer.received[at : at + 5] for at in range(0, len(peer.received), 5)}
        assert received == {bytes.fromhex(each) for each in REQUESTS[edition].split()}


def test_identify_verb_prints_edition_firmware_and_evidence(arm: tuple[str, str]) -> None:
    edition, url = arm
    result = run_program("identify", url, "--timeout", "0.3")
    assert (result.returncode, result.stderr) == (0, "")
    first, *evidence = result.stdout.splitlines()
    assert first.startswith(f"{url}: edition {edition}")
    assert ("firmware" in first) == (edition == "mycobot280")
    assert "is_power_on" in evidence[0]
    assert f"only {edition} has this query" in evidence[-1]


@pytest.mark.parametrize(
    ("replies", "edition", "code"),
    [
        ([[POWERED], [bytes.fromhex("FE FE 03 02 49 FA")]], "mycobot280", 0),
        ([[POWERED]], "", 1),
        ([], "", 4),
    ],
)
def test_identify_verb_has_json_and_an_exit_code_for_each_outcome(
    replies: list[list[bytes]], edition: str, code: int
) -> None:
    with ScriptedPeer(*replies) as peer:
        result = run_program("identify", peer.url, "--json", "--timeout", "0.15")
        report = json.loads(result.stdout)
        assert (result.returncode, report["edition"], report["url"]) == (code, edition, peer.url)
    assert report["firmware"] == ("7.3" if edition else "")
    assert report["evidence"][-1]["replied"] == bool(edition)


def test_identify_verb_without_a_port_exits_with_3() -> None:
    assert run_program("identify", "/dev/nosuchport").returncode == 3


def test_late_reply_to_a_query_is_left_to_the_next_client_on_the_port() -> None:
    with ScriptedPeer() as peer:
        transport = open_transport(peer.url, 115200)
        identify_on(transport, timeout=0.05)
        late = [frame.request for frame in PortMemory(transport).recall().late]
        transport.close()
    assert late == [bytes.fromhex("FE FE 02 12 FA")]
