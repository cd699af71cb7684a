"""Check the parts between the transport and the pages, for every edition and with faults."""

from __future__ import annotations

import asyncio
import json
import socket
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, closing, suppress
from functools import partial
from itertools import product
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.editions import mycobot280
from cobotwire.editions.mycobot280 import Angles
from cobotwire.editions.mycobot280 import messages as m
from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.protocol.limits import Limits, limited
from cobotwire.protocol.refusals import refusals
from cobotwire.simulator import SimulatedArm, TcpServer
from cobotwire.simulator.faults import find
from cobotwire.studio import arm_line
from cobotwire.studio.arm_line import UNANSWERED, ArmLine, PortOptions
from cobotwire.studio.controls import controls
from cobotwire.studio.describing import Described, Describer
from cobotwire.studio.entries import Entry
from cobotwire.studio.explained import Explainer
from cobotwire.studio.forms import forms
from cobotwire.studio.history import KEPT_ENTRIES, History
from cobotwire.studio.holding import Holding
from cobotwire.studio.live import LiveSession
from cobotwire.studio.robot_facts import robot_facts
from cobotwire.studio.sending import Control, NotPermitted, Preparer
from cobotwire.studio.serving import Options, staged
from cobotwire.studio.stage import Stage
from cobotwire.studio.viewers import QUEUED_ENTRIES, Viewer

EDITIONS = editions.names()


def _filled(argument: dict[str, Any], given: dict[str, str], end: str) -> str | None:
    """Return the words that a user of the page writes for one end of each range."""
    elements = argument.get("elements") or []
    for case in argument.get("cases", ()):
        if given[argument["selector"]] in map(str, case["when"]):
            elements = case["elements"]
    if argument.get("choices") and len(elements) < 2:
        return str(argument["choices"][0 if end == "low" else -1]["value"])
    if elements and not argument.get("list"):
        return ",".join(str(each[end] if each[end] is not None else 0) for each in elements)
    texts = {"bytes": "00" * argument.get("size", 1), "text": "a" * argument.get("size", 3)}
    return texts.get(argument["kind"])


@pytest.mark.parametrize("name", EDITIONS)
def test_every_command_can_be_sent_from_its_form(name: str) -> None:
    edition = editions.load(name)
    preparer, explainer = Preparer(edition.TABLE), Explainer(edition, codecs.load(edition.TABLE))
    for form, end in product(forms(edition.TABLE), ("low", "high")):
        command, given = preparer.command(form["name"]), dict[str, str]()
        for argument in sorted(form["arguments"], key=lambda each: "selector" in each):
            text = _filled(argument, given, end)
            # `speed` and `speeds` exclude each other: users of the page leave one empty.
            exclusive = argument["optional"] and argument["name"] == "speeds"
            if text is not None and not exclusive:
                given[argument["name"]] = text
        encoded = preparer.encoded(command, preparer.arguments(command, given))
        if end == "high":
            explained = explainer.frame(encoded.frame + encoded.text)
            assert explained["command"]["place"], form["name"]
            shown = " ".join(part["hex"] for part in explained["parts"] if part["hex"])
            assert shown == explained["hex"], form["name"]


@pytest.mark.parametrize("name", EDITIONS)
def test_every_edition_has_facts_for_the_page(name: str) -> None:
    table = editions.load(name).TABLE
    facts = robot_facts(table)
    assert len(facts["joints"]) == table.joints or name.startswith("my")
    assert bool(facts["reach"]) == (facts["noGeometry"] == "")
    assert json.loads(json.dumps(facts)) == facts


@pytest.mark.parametrize("limits", [Limits(), Limits(speed=20)], ids=["unlimited", "slow"])
@pytest.mark.parametrize("name", EDITIONS)
def test_each_control_sends_a_request_of_the_edition(name: str, limits: Limits) -> None:
    edition = editions.load(name).TABLE
    table = limited(edition, limits)
    found = controls(table, refusals(edition, limits))
    preparer = Preparer(edition, limits=limits)
    joints = robot_facts(table)["joints"]
    for control in ("joint", "coordinate", "jogJoint", "jogCoordinate", "gripper"):
        use = found[control]
        if use is None:
            continue
        names, numbers = use["arguments"], use["elements"] or [{"low": 1.0}]
        assert "at" not in names or len(use["places"]) >= (len(joints) if "Joint" in control else 3)
        for at, number in enumerate(numbers):
            given = {names["speed"]: str(found["speeds"]["high"])} if "speed" in names else {}
            given |= {names["at"]: str(use["places"][at])} if "at" in names else {}
            given |= {names["to"]: str(number["low"])} if "to" in names else {}
            given |= {names["direction"]: str(found["forward"])} if "direction" in names else {}
            command = preparer.command(use["command"])
            preparer.encoded(command, preparer.arguments(command, given))
    assert (found["jogJoint"] is None) == (name in ("myarm_c650", "myarm_m750"))
    assert not found["speeds"] or found["speeds"]["high"] == (limits.speed or 100)


MOVE = {"angles": "0,0,0,0,0,0", "speed": "30"}


def test_page_offers_what_a_workspace_allows_and_the_server_refuses_the_rest() -> None:
    limits = Limits(speed=30, workspace=[None, None, (100, 450)])
    with staged(Options(None, "mycobot280", limits=limits, silence=0.2)) as stage:
        viewer = Viewer()
        stage.open(viewer)
        stage.set_control(viewer.page, True)
        stage.set_motion(viewer.page, True)
        offered = stage.hello(viewer)["controls"]
        assert offered["joint"]["command"] == "send_angles", "a single joint is refused"
        assert offered["jogJoint"] is offered["jogCoordinate"] is None
        assert offered["speeds"]["high"] == 30
        assert offered["coordinate"]["elements"][2]["low"] == 100

        def send(command: str, **given: str) -> None:
            asyncio.run(stage.send(viewer.page, command, given, 0, force=True))

        async def hold() -> list[str]:
            refused: list[str] = []
            holding = Holding(stage, viewer.page, refused.append)
            holding.hold("send_angles", MOVE, 0)
            await asyncio.sleep(0.5)
            await holding.end()
            return refused

        send("send_angles", **MOVE)
        for command, given, error in (
            ("send_angles", MOVE | {"speed": "31"}, "speed is 31"),
            ("send_angles", MOVE | {"angles": "0,130,0,0,0,0"}, r"allows z 100\.\.450 mm"),
            ("jog_angle", {"joint": "1", "direction": "1", "speed": "9"}, "is refused"),
        ):
            with pytest.raises(UsageError, match=error):
                send(command, **given)
        assert "no longer reported that the button is held" in asyncio.run(hold())[0]
        assert isinstance(stage.session, LiveSession)
        assert isinstance(stage.session.line, ArmLine)
        sent = [frame[3] for frame in _sent(stage.session.line)]
        assert [each for each in sent if each in (0x22, 0x29, 0x30)] == [0x22, 0x22, 0x29]


def _targets(*steps: tuple[str, Any]) -> list[Any]:
    """Return the targets that pages know after each request and reply."""
    codec, shown = codecs.load(mycobot280.TABLE), []
    describer, target = Describer(codec), None
    for name, message in steps:
        reply = hasattr(message, "result")
        data = codec.encode(name, "reply" if reply else "request", message.values)
        entry = Entry(0.0, "received" if reply else "sent", data)
        for sample in map(json.loads, describer.describe(0, entry).samples):
            target = sample.get("tj", target) or sample.get("te", None)
        shown.append(target)
    return shown


def test_target_ends_when_it_is_reached_stopped_or_replaced() -> None:
    there, end = [10.0] * 6, [100.0, 0.0, 200.0, 0.0, 0.0, 0.0]
    at_rest = ("get_angles", m.GetAnglesReply(Angles(*[0.0] * 6)))
    reached = ("get_angles", m.GetAnglesReply(Angles(*[10.2] * 6)))
    go = ("send_angles", m.SendAngles(there, 50))
    assert _targets(go, at_rest, reached) == [there, there, None]
    assert _targets(go, ("stop", m.Stop())) == [there, None]
    assert _targets(go, ("jog_angle", m.JogAngle(1, 1, 20))) == [there, None]
    assert _targets(go, ("set_gripper_value", m.SetGripperValue(10, 50))) == [there, there]
    assert _targets(go, ("send_coords", m.SendCoords(end, 50, 0))) == [there, end[:3]]
    assert (
        _targets(at_rest, ("send_angle", m.SendAngle(2, 30.0, 50)), at_rest)[1:]
        == [[0.0, 30.0, 0.0, 0.0, 0.0, 0.0]] * 2
    )


def test_query_that_an_arm_never_answers_does_not_slow_down_the_others() -> None:
    table = editions.load("mercury_a1").TABLE
    coordinates = bytes([table.in_role("coordinates").id])
    with (
        TcpServer(SimulatedArm(table).connect) as server,
        ArmLine(editions.load("mercury_a1"), PortOptions(server.url), 100.0) as polled,
    ):
        sent: list[bytes] = []
        end = time.monotonic() + 30
        while len([data for data in sent if data[3:4] != coordinates]) < 60:
            assert time.monotonic() < end
            time.sleep(0.02)
            sent += _sent(polled)
    # Each query is sent three times before it counts as unanswered.
    assert len([data for data in sent if data[3:4] == coordinates]) <= 3 * UNANSWERED


@pytest.fixture
def line(request: pytest.FixtureRequest) -> Iterator[ArmLine]:
    """Poll a simulated arm under a fault scenario."""
    arm = SimulatedArm(mycobot280.TABLE, powered=True)
    scenario = find(request.param, mycobot280.TABLE)
    codec = codecs.load(mycobot280.TABLE)
    with (
        TcpServer(lambda: scenario.wrap(arm.connect(), codec)) as server,
        ArmLine(editions.load("mycobot280"), PortOptions(server.url), 100.0) as polled,
    ):
        yield polled


@pytest.mark.parametrize("line", ["servo-leaks", "corrupted-replies"], indirect=True)
def test_every_byte_of_a_bad_line_is_in_one_entry(line: ArmLine) -> None:
    polled = line
    session = LiveSession(polled, deque())
    traffic = []
    take = polled.take

    def note() -> Any:
        new = take()
        traffic.extend(new)
        return new

    polled.take = note  # type: ignore[method-assign]
    end = time.monotonic() + 20
    while not any(entry.finding for entry in session.entries()[:-20]):
        assert time.monotonic() < end
        session.pass_on()
        time.sleep(0.02)
    polled.__exit__()
    session.pass_on()
    time.sleep(0.35)
    session.pass_on()
    for direction in ("sent", "received"):
        shown = [entry.data for entry in session.entries() if entry.direction == direction]
        whole = b"".join(each.data for each in traffic if each.direction == direction)
        assert b"".join(shown) == whole
    times = [entry.time for entry in session.entries() if entry.direction == "received"]
    assert times == sorted(times)


@pytest.fixture
def idle_line() -> Iterator[ArmLine]:
    """Return the studio's line to an arm that has power and is not polled."""
    arm = SimulatedArm(mycobot280.TABLE, powered=True)
    with (
        TcpServer(arm.connect) as server,
        ArmLine(editions.load("mycobot280"), PortOptions(server.url), 0.0) as line,
    ):
        yield line


def _sent(line: ArmLine) -> list[bytes]:
    return [each.data for each in line.take() if each.direction == "sent"]


MOTION = {"angles": [10.0] * 6, "speed": 50}
STOP = bytes.fromhex("FE FE 02 29 FA")


def test_motion_that_waited_is_not_sent_after_a_stop(idle_line: ArmLine) -> None:
    command, stops = idle_line.table.command("send_angles"), idle_line.stops
    idle_line.stop()
    with pytest.raises(NotPermitted, match="stopped meanwhile"):
        idle_line.call(command, MOTION, True, lambda: None, stops)
    assert _sent(idle_line) == [STOP]


def test_stop_that_overtakes_a_motion_is_sent_again(idle_line: ArmLine) -> None:
    command = idle_line.table.command("send_angles")
    idle_line.call(command, MOTION, True, idle_line.stop, idle_line.stops)
    first, motion, last = _sent(idle_line)
    assert first == last == STOP
    assert motion[3] == command.id


def test_motion_whose_permission_ended_is_not_sent(idle_line: ArmLine) -> None:
    command, control = idle_line.table.command("send_angles"), Control(True)
    control.take("page")
    permit = partial(control.check, "page", command)
    with pytest.raises(NotPermitted, match="allow motion"):
        idle_line.call(command, MOTION, True, permit, idle_line.stops)
    assert _sent(idle_line) == []


class _Port:
    """Takes what a line sends and never replies; it can be gone for a while."""

    def __init__(self) -> None:
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.url = f"socket://127.0.0.1:{self._listening.getsockname()[1]}"
        self._peers, self.gone = list[socket.socket](), False
        self.received: list[bytes] = []
        self._thread = threading.Thread(target=self._accept, daemon=True)
        self._thread.start()

    def cut(self) -> None:
        self.gone = True
        for peer in self._peers:
            with suppress(OSError):
                peer.shutdown(socket.SHUT_RDWR)
        self._peers.clear()

    def close(self) -> None:
        self.cut()
        with suppress(OSError):
            self._listening.shutdown(socket.SHUT_RDWR)
        self._listening.close()
        self._thread.join(5)

    def _accept(self) -> None:
        while True:
            try:
                peer, _ = self._listening.accept()
            except OSError:
                return
            if self.gone:
                peer.close()
                continue
            self._peers.append(peer)
            threading.Thread(target=self._read, args=(peer,), daemon=True).start()

    def _read(self, peer: socket.socket) -> None:
        with peer, suppress(OSError):
            while data := peer.recv(4096):
                self.received.append(data)


@pytest.mark.parametrize("how", ["stop", "hold", "hold that is not released"])
def test_stop_that_failed_without_the_port_is_sent_when_the_port_is_back(
    how: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(arm_line, "REOPEN_SECONDS", 0.05)

    async def run(port: _Port) -> int:
        refused: list[str] = []
        options = Options(port.url, "mycobot280", rate=0.0, allow_motion=True, silence=30.0)
        with staged(options) as stage:
            viewer = Viewer()
            stage.open(viewer)
            stage.set_control(viewer.page, True)
            stage.set_motion(viewer.page, True)
            assert isinstance(stage.session, LiveSession)
            line = stage.session.line
            assert isinstance(line, ArmLine)
            holding = Holding(stage, viewer.page, refused.append)
            if how != "stop":
                holding.hold("jog_angle", {"joint": "1", "direction": "1", "speed": "9"}, 0)
            port.cut()
            await _until(lambda: line.problem)
            if how == "stop":
                with pytest.raises(LinkError):
                    await stage.stop()
            elif how == "hold":
                holding.release()
                await _until(lambda: any("stop was NOT sent" in text for text in refused))
            port.received.clear()
            port.gone = False
            await _until(lambda: STOP in port.received)
            await asyncio.sleep(0.2)
            return port.received.count(STOP)

    with closing(_Port()) as port:
        assert asyncio.run(run(port)) == 1


async def _until(condition: Callable[[], object]) -> None:
    async with asyncio.timeout(10):
        while not condition():
            await asyncio.sleep(0.01)


@pytest.mark.parametrize("how", ["stop", "motion off", "control released"])
def test_request_that_waits_for_another_reply_is_not_sent_once_it_may_not_be(how: str) -> None:
    power = editions.load("mercury_a1").TABLE.command("power_on")
    assert power.requires_reply

    async def run(port: _Port) -> None:
        with staged(Options(port.url, "mercury_a1", allow_motion=True)) as stage:
            viewer = Viewer()
            stage.open(viewer)
            stage.set_control(viewer.page, True)
            stage.set_motion(viewer.page, True)
            # The arm does not reply to the poll.
            await _until(lambda: port.received)
            sending = asyncio.create_task(stage.send(viewer.page, "power_on", {}, 0, force=False))
            await asyncio.sleep(0.1)
            if how == "stop":
                await stage.stop()
            elif how == "motion off":
                stage.set_motion(viewer.page, False)
            else:
                stage.set_control(viewer.page, False)
            with pytest.raises(NotPermitted):
                await sending
            await asyncio.sleep(0.1)
            assert not any(data[3] == power.id for data in port.received)

    with closing(_Port()) as port:
        asyncio.run(run(port))


def test_motion_needs_an_address_if_all_devices_would_move() -> None:
    def stage(**given: Any) -> AbstractContextManager[Stage]:
        return staged(Options(port.url, "mybuddy", rate=0.0, **given))

    with closing(_Port()) as port:
        with pytest.raises(UsageError, match="address") as refused, stage(allow_motion=True):
            pass
        assert "LEFT" in str(refused.value)
        assert port.received == []
        with stage(), stage(allow_motion=True, address="LEFT"):
            pass


def test_history_keeps_the_last_entries_by_their_numbers() -> None:
    history = History()
    for number in range(KEPT_ENTRIES + 10):
        history.add(Entry(float(number), "sent", b""), Described(str(number), (f"s{number}",)))
    assert history.find(9) is None
    assert history.find(10) == Entry(10.0, "sent", b"")
    assert history.find(KEPT_ENTRIES + 10) is None
    assert history.find(-1) is None
    assert history.last(2, 1) == (
        [str(KEPT_ENTRIES + 8), str(KEPT_ENTRIES + 9)],
        [f"s{KEPT_ENTRIES + 9}"],
    )


def test_slow_page_loses_the_oldest_entries_and_says_how_many() -> None:
    async def watch() -> dict[str, Any]:
        viewer = Viewer()
        for number in range(QUEUED_ENTRIES + 50):
            viewer.push([Described(str(number), ())])
        async for batch in viewer.batches():
            return dict(json.loads(batch))
        raise AssertionError("there was no batch")

    batch = asyncio.run(watch())
    assert batch["states"]["lost"] == 50
    assert batch["entries"] == list(range(50, QUEUED_ENTRIES + 50))


def test_text_from_the_line_is_data_in_the_json() -> None:
    hostile = b"</script><img src=x onerror=alert(1)>\r\n"
    describer = Describer(codecs.load(mycobot280.TABLE))
    written = json.loads(describer.describe(0, Entry(0.0, "received", hostile)).entry)
    assert written["k"] == "noise"
    assert bytes.fromhex(written["h"]) == hostile
