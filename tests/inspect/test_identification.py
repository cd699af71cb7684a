"""Identify and connect on simulated arms of both editions, over a pty and over TCP."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

import cobotwire
from cobotwire import EditionUnknown, LinkError, MyCobot280, connect, identify
from cobotwire.client.port_memory import PortMemory
from cobotwire.editions import load, names
from cobotwire.inspect.evidence import own_query
from cobotwire.inspect.identification import identify_on
from cobotwire.simulator import PtyServer, SimulatedArm, TcpServer
from cobotwire.transport import open_transport
from command_line import run_program
from scripted_peer import ScriptedPeer

POWERED = bytes.fromhex("FE FE 03 12 01 FA")
ANGLES = bytes.fromhex("FE FE 0E 20" + "00 00" * 6 + "FA")
VERSION = bytes.fromhex("FE FE 03 02 49 FA")
REQUESTS = {
    "mycobot": "FEFE0212FA FEFE0220FA FEFE0202FA FEFE0240FA",
    "mycobot280": "FEFE0212FA FEFE0220FA FEFE0202FA FEFE021BFA",
}
# Editions with a query that no other edition has; in the others a limit of a joint decides.
OWN_QUERIES = {
    "mycobot": "get_speed",
    "mycobot280": "check_async_or_sync",
    "mecharm270": None,
    "mypalletizer260": "get_angles",
}


@pytest.fixture(params=[(e, "pty") for e in names()] + [("mycobot280", "tcp")])
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
    tables = {name: load(name).TABLE for name in names()}
    found = {
        name: own_query(table, [other for other in tables.values() if other is not table])
        for name, table in tables.items()
    }
    assert {name: query and query.name for name, query in found.items()} == OWN_QUERIES


def test_identify_recognises_edition_and_firmware_of_a_simulated_arm(arm: tuple[str, str]) -> None:
    edition, url = arm
    found = identify(url, timeout=0.3)
    assert (found.edition, found.candidates, found.url) == (edition, (edition,), url)
    assert bool(found.firmware) == (edition != "mycobot")
    assert found.evidence[-1].replied
    assert found.evidence[-1].edition == edition


def test_connect_returns_the_client_of_the_arms_edition(arm: tuple[str, str]) -> None:
    edition, url = arm
    with connect(url, timeout=0.3) as client:
        assert type(client) is load(edition).CLIENT
        client.power_on()
        assert client.is_power_on() is True
    with connect(url, timeout=0.3) as again:
        assert again.is_power_on() is True


def test_connect_async_returns_an_open_asyncio_client(arm: tuple[str, str]) -> None:
    edition, url = arm

    async def use() -> tuple[str, bool]:
        async with await cobotwire.connect_async(url, timeout=0.3) as client:
            return type(client).__name__, await client.is_power_on()

    assert asyncio.run(use()) == (load(edition).ASYNC_CLIENT.__name__, False)


def test_connect_without_a_reply_or_a_decision_names_the_queries_and_closes_the_port() -> None:
    with ScriptedPeer() as peer:
        with pytest.raises(EditionUnknown, match=r"is_power_on: no reply\); .*MyCobot280"):
            connect(peer.url, timeout=0.1)
        MyCobot280(peer.url).close()
    with ScriptedPeer([POWERED], [ANGLES]) as peer:
        with pytest.raises(EditionUnknown, match="get_system_version: no reply; get_speed: no rep"):
            connect(peer.url, timeout=0.1)
    with pytest.raises(LinkError):
        connect("/dev/nosuchport")


@pytest.mark.parametrize("edition", ["mycobot", "mycobot280"])
def test_identify_sends_nothing_but_its_harmless_queries(edition: str) -> None:
    own = {"mycobot280": "FE FE 03 1B 01 FA", "mycobot": "FE FE 03 40 32 FA"}[edition]
    version = [VERSION] if edition == "mycobot280" else []
    with ScriptedPeer([POWERED], [ANGLES], version, [bytes.fromhex(own)]) as peer:
        assert identify(peer.url, timeout=0.15).edition == edition
        received = {peer.received[at : at + 5] for at in range(0, len(peer.received), 5)}
        assert received == {bytes.fromhex(each) for each in REQUESTS[edition].split()}


def test_identify_verb_prints_edition_firmware_and_evidence(arm: tuple[str, str]) -> None:
    edition, url = arm
    result = run_program("identify", url, "--timeout", "0.3")
    assert (result.returncode, result.stderr) == (0, "")
    first, *evidence = result.stdout.splitlines()
    assert first.startswith(f"{url}: edition {edition}")
    assert ("firmware" in first) == (edition != "mycobot")
    assert "is_power_on" in evidence[0]
    own = OWN_QUERIES[edition] not in (None, "get_angles")
    decisive = f"only {edition} has this query" if own else f"in {edition}"
    assert decisive in evidence[-1]


def test_edition_without_a_query_of_its_own_is_known_by_a_limit_or_else_a_candidate() -> None:
    silent: list[bytes] = []
    for limit, edition in (
        ("00 02 8A", "mecharm270"),
        ("00 05 DC", "mycobot280"),
        ("00 03 20", ""),
    ):
        reply = bytes.fromhex(f"FE FE 05 4B {limit} FA".replace("4B 00", "4B 03"))
        with ScriptedPeer([POWERED], [ANGLES], [VERSION], silent, [reply], [reply]) as peer:
            found = identify(peer.url, timeout=0.15)
        assert found.edition == edition
        assert found.candidates == ((edition,) if edition else ("mecharm270", "mycobot280"))


@pytest.mark.parametrize(
    ("replies", "edition", "code"),
    [
        ([[POWERED], [ANGLES], [VERSION], [bytes.fromhex("FE FE 03 1B 01 FA")]], "mycobot280", 0),
        ([[POWERED], [ANGLES]], "", 1),
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
