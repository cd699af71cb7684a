"""Identify and connect on simulated arms of both editions, over a pty and over TCP."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

import cobotwire
from cobotwire import EditionUnknown, LinkError, MyCobot280, codec, connect, identify
from cobotwire.client.persisted_state import PersistedSession
from cobotwire.editions import load, names
from cobotwire.inspect.identification import identify_on
from cobotwire.session import RequestReceived
from cobotwire.session.device import DeviceEvent
from cobotwire.simulator import PtyServer, SimulatedArm, TcpServer
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.faults import Scenario, Silent
from cobotwire.simulator.memory import MemoryTransport
from cobotwire.transport import open_transport
from in_process import cobotwire as run_program
from scripted_peer import ScriptedPeer

ANGLES = bytes.fromhex("FE FE 0E 20" + "00 00" * 6 + "FA")
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
SPEED = bytes.fromhex("FE FE 03 40 32 FA")


# One edition for each kind of evidence: queries, frames, or a limit. Another test has all editions.
KINDS = [("mycobot", "pty"), ("mycobot280", "pty"), ("mybuddy", "tcp"), ("mecharm270", "pty")]
# Simulated arms of these editions reply to the same queries: the queries that differ need a known
# geometry or an argument.
ALIKE = ("mercury_a1", "mercury_b1", "mercury_x1")
CANDIDATES: dict[str, tuple[str, ...]] = dict.fromkeys(ALIKE, ALIKE)
# The M750 has every query of the C650, so only missing replies show a C650.
CANDIDATES["myarm_c650"] = ("myarm_c650", "myarm_m750")


@pytest.fixture(params=KINDS)
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


def test_identify_recognises_edition_and_firmware_of_a_simulated_arm(arm: tuple[str, str]) -> None:
    edition, url = arm
    found = identify(url, timeout=0.3)
    assert (found.edition, found.candidates, found.url) == (edition, (edition,), url)
    assert bool(found.firmware) == (edition != "mycobot")
    assert found.evidence[-1].replied


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
            return type(client).__name__, bool(await client.is_power_on())

    assert asyncio.run(use()) == (load(edition).ASYNC_CLIENT.__name__, False)


def test_connect_without_a_reply_or_a_decision_names_the_queries_and_closes_the_port() -> None:
    with ScriptedPeer() as peer:
        with pytest.raises(EditionUnknown, match=r"is_power_on: no reply; .*MyCobot280"):
            connect(peer.url, timeout=0.1)
        MyCobot280(peer.url).close()
    with ScriptedPeer([POWERED], [ANGLES]) as peer:
        with pytest.raises(EditionUnknown, match="get_system_version: no reply; get_speed: no rep"):
            connect(peer.url, timeout=0.1)
    with pytest.raises(LinkError):
        connect("/dev/nosuchport")


@pytest.mark.parametrize("edition", names())
def test_identify_sends_few_requests_and_only_queries(edition: str) -> None:
    table = load(edition).TABLE
    received: list[str] = []

    def note(event: DeviceEvent, reply: bytes) -> None:
        if isinstance(event, RequestReceived):
            received.append(event.message.command.name)

    with PtyServer(SimulatedArm(table, on_event=note)) as server:
        found = identify(server.url, timeout=0.15)
    several = CANDIDATES.get(edition, (edition,))
    assert found.edition == ("" if len(several) > 1 else edition)
    assert found.candidates == several
    assert {table.command(name).safety for name in received} == {"query"}
    # The last queries read the arm's position, to compare angles with coordinates.
    assert len(received) <= 8
    assert len(found.evidence) <= 8


def _at_rate(
    monkeypatch: pytest.MonkeyPatch, edition: str, right: int
) -> list[tuple[str, int, MemoryTransport]]:
    """Serve an arm at one baud rate in memory; return the ports that are opened."""
    opened: list[tuple[str, int, MemoryTransport]] = []

    def open_at(port: str, rate: int) -> MemoryTransport:
        clock = SteppedClock()
        arm = SimulatedArm(load(edition).TABLE, clock=clock)
        peer = (
            arm
            if rate == right
            else Scenario(name="deaf", faults=(Silent(),)).wrap(
                arm, codec.load(load(edition).TABLE), clock=clock
            )
        )
        opened.append((port, rate, MemoryTransport(peer, clock)))
        return opened[-1][2]

    monkeypatch.setattr("cobotwire.inspect.identification.open_port", open_at)
    return opened


def test_arm_at_another_baud_rate_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    opened = _at_rate(monkeypatch, "mycobot280_rdkx5", 1_000_000)
    found = identify("/dev/ttyS1", timeout=0.3)
    assert (found.edition, found.baudrate) == ("mycobot280_rdkx5", 1_000_000)
    assert found.evidence[-1].shows.endswith(", at 1,000,000 baud")
    # The Mercury's frames are sent only at rates that a Mercury has.
    assert sum("at 1,000,000 baud" not in each.shows for each in found.evidence) >= 2
    assert not any("mercury" in e.shows for e in found.evidence if "1,000,000" in e.shows)
    assert [rate for _, rate, _ in opened] == [115_200, 1_000_000]
    with connect("/dev/ttyS1", timeout=0.3) as arm:
        assert type(arm).__name__ == "MyCobot280RDKX5"
    assert len(opened) == 4


def test_given_baud_rate_and_urls_are_tried_once(monkeypatch: pytest.MonkeyPatch) -> None:
    opened = _at_rate(monkeypatch, "mycobot280", 57_600)
    assert identify("/dev/ttyS1", baudrate=57_600, timeout=0.3).edition == "mycobot280"
    assert not identify("socket://host:1", timeout=0.3).replied
    assert not identify("/dev/ttyS1", timeout=0.3).replied
    assert [rate for _, rate, _ in opened] == [57_600, 115_200, 115_200, 1_000_000]


def test_identify_subcommand_prints_edition_firmware_and_evidence(arm: tuple[str, str]) -> None:
    edition, url = arm
    result = run_program("identify", url, "--timeout", "0.3")
    assert (result.returncode, result.stderr) == (0, "")
    first, *evidence = result.stdout.splitlines()
    assert first.startswith(f"{url}: edition {edition}")
    assert ("firmware" in first) == (edition != "mycobot")
    assert "is_power_on" in evidence[0]
    assert edition in evidence[-1]


def test_connect_names_the_candidates_if_neither_queries_nor_limits_decide() -> None:
    simulated = SimulatedArm(load("mecharm270").TABLE)
    simulated.state.minimum, simulated.state.maximum = [-10.0] * 6, [10.0] * 6
    with PtyServer(simulated) as server:
        with pytest.raises(EditionUnknown, match=r"Its replies allow .*mecharm270") as caught:
            connect(server.url, timeout=0.15)
        assert {"mecharm270", "mycobot280"} <= set(caught.value.candidates)
        assert "mycobot" not in caught.value.candidates


@pytest.mark.parametrize(
    ("replies", "edition", "code"),
    [
        ([[POWERED], [ANGLES], [], [SPEED]], "mycobot", 0),
        ([[POWERED], [ANGLES]], "", 1),
        ([], "", 4),
    ],
)
def test_identify_subcommand_has_json_and_an_exit_code_for_each_outcome(
    replies: list[list[bytes]], edition: str, code: int
) -> None:
    with ScriptedPeer(*replies) as peer:
        result = run_program("identify", peer.url, "--json", "--timeout", "0.15")
        report = json.loads(result.stdout)
        assert (result.returncode, report["edition"], report["url"]) == (code, edition, peer.url)
    assert report["firmware"] == ""
    assert report["evidence"][-1]["replied"] == bool(edition)


def test_identify_subcommand_without_a_port_exits_with_3() -> None:
    assert run_program("identify", "/dev/nosuchport").returncode == 3


def test_late_reply_to_a_query_is_left_to_the_next_client_on_the_port() -> None:
    with ScriptedPeer() as peer:
        transport = open_transport(peer.url, 115200)
        identify_on(transport, timeout=0.05)
        late = [frame.request for frame in PersistedSession(transport).recall().late]
        transport.close()
    # One query for each frame format that was tried.
    assert bytes.fromhex("FE FE 02 12 FA") in late
    assert bytes.fromhex("FE FE 00 02 12 12") in late
