"""A request that is alone on its line is exchanged in one native call, with the same results."""

from __future__ import annotations

import asyncio
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cobotwire import AsyncMyCobot, MyCobot, ReplyTimeout, RetryPolicy
from cobotwire import codec as codecs
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.errors import CobotwireError
from cobotwire.session import EncodedRequest
from scripted_peer import ScriptedPeer

pytestmark = pytest.mark.skipif(not codecs.native_available(), reason="there is no native module")
ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
REQUEST = bytes.fromhex("FE FE 02 20 FA")
ILLEGAL = bytes.fromhex("FE FE 0E 20 7F FF 00 3D FF E6 FF 3F 00 AF FF 51 FA")
OTHER = bytes.fromhex("FE FE 03 2B 00 FA")
POWER = bytes.fromhex("FE FE 03 12 01 FA")
# Pauses between parts are long enough for a read of its own, or there is no pause.
PAUSE = 0.004
PARTS = st.sampled_from(
    [ANGLES, ANGLES[:7], ANGLES[7:], REQUEST, ILLEGAL, OTHER, POWER, b"boot\r\n", b"\xfe", PAUSE]
)
SCRIPTS = st.lists(
    st.one_of(st.just([ANGLES]), st.lists(PARTS, max_size=4)), min_size=1, max_size=3
)
FAST = RetryPolicy(attempts=1, grace=0.0)


def results(scripts: list[list[Any]], *, alone: bool) -> list[object]:
    """Return what calls return or raise if the peer plays the scripts."""
    found: list[object] = []
    with (
        ScriptedPeer(*scripts) as peer,
        MyCobot(peer.url, timeout=0.05, retry=FAST, codec="native") as arm,
    ):
        connection = arm._connection
        assert connection._native is not None
        if not alone:
            connection._native = None
        for _ in scripts:
            try:
                found.append(arm.get_angles())
            except ReplyTimeout as error:
                found.append((error.request, error.received, error.attempts))
            except CobotwireError as error:
                found.append((type(error), str(error)))
            # What the script still sends belongs to this call.
            time.sleep(4 * PAUSE)
            arm.listen(0.001)
    return [*found, peer.received]


async def async_results(scripts: list[list[Any]], *, alone: bool) -> list[object]:
    """Return the same of the asyncio client."""
    found: list[object] = []
    with ScriptedPeer(*scripts) as peer:
        async with AsyncMyCobot(peer.url, timeout=0.05, retry=FAST, codec="native") as arm:
            steps = arm._connection._steps
            assert steps is not None
            assert steps.native is not None
            if not alone:
                steps.native = None
            for _ in scripts:
                try:
                    found.append(await arm.get_angles())
                except ReplyTimeout as error:
                    found.append((error.request, error.received, error.attempts))
                except CobotwireError as error:
                    found.append((type(error), str(error)))
                await asyncio.sleep(4 * PAUSE)
        return [*found, peer.received]


def run_async(scripts: list[list[Any]], *, alone: bool) -> list[object]:
    return asyncio.run(async_results(scripts, alone=alone))


@pytest.mark.parametrize("run", [results, run_async], ids=["blocking", "asyncio"])
@given(scripts=SCRIPTS)
@settings(max_examples=25, deadline=None)
def test_same_traffic_has_the_same_results_in_one_call_and_in_steps(run: Any, scripts: Any) -> None:
    in_steps = run(scripts, alone=False)
    # A part that comes late on a busy machine is another traffic.
    for _ in range(3):
        in_one = run(scripts, alone=True)
        if in_one == in_steps:
            return
        in_steps = run(scripts, alone=False)
    assert in_one == in_steps


@contextmanager
def ctrl_c_soon() -> Iterator[None]:
    """Raise KeyboardInterrupt in the block, by a signal."""

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.01)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_ctrl_c_ends_the_wait_and_the_late_reply_holds_the_next_call() -> None:
    other = bytes.fromhex("FE FE 0E 20 01 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
    # The first reply is late; the second one is the reply to the second call.
    with (
        ScriptedPeer([0.3, ANGLES], [other]) as peer,
        MyCobot(peer.url, timeout=20.0, retry=RetryPolicy(attempts=1, grace=0.6)) as arm,
    ):
        started = time.monotonic()
        with ctrl_c_soon(), pytest.raises(KeyboardInterrupt):
            arm.get_angles()
        assert time.monotonic() - started < 10
        assert arm.get_angles()[0] == 3.96


@pytest.mark.parametrize("written", [True, False])
def test_interrupted_request_is_noted_for_the_next_session_if_it_was_written(written: bool) -> None:
    with ScriptedPeer() as peer, MyCobot(peer.url) as arm:
        connection, exchange = arm._connection, arm._connection._exchange
        native = connection._native
        assert native is not None
        request = EncodedRequest(TABLE.command("get_angles"), REQUEST, b"", {}, plain=True)
        at = 0.0 if written else time.monotonic() + 60
        with ctrl_c_soon(), pytest.raises(KeyboardInterrupt):
            native.lone(native, request, RetryPolicy(attempts=1), 20.0, at)
        late = [reply.request for reply in exchange.leave(connection.now()).late]
        assert late == [REQUEST] * written


@pytest.mark.parametrize("reader", ["nobody", "listener", "log", "recording"])
def test_traffic_that_somebody_reads_is_reported_step_by_step(
    reader: str, tmp_path: Any, caplog: pytest.LogCaptureFixture
) -> None:
    record = tmp_path / "traffic.pcapng" if reader == "recording" else None
    traffic: list[object] = []
    calls: list[object] = []
    with ScriptedPeer([ANGLES]) as peer, MyCobot(peer.url, record=record, codec="native") as arm:
        native = arm._connection._native
        # A recording needs the time of each write and read.
        assert (native is None) == (reader == "recording")
        if native is not None:
            call = native.lone
            native.lone = lambda *given: calls.append(given) or call(*given)  # type: ignore[func-returns-value]
        if reader == "listener":
            arm.add_traffic_listener(traffic.append)
        if reader == "log":
            caplog.set_level("DEBUG", logger="cobotwire.traffic")
        assert arm.get_angles()[0] == 1.4
    assert bool(calls) == (reader == "nobody")
    assert len(traffic) == (2 if reader == "listener" else 0)
    assert (f"> {REQUEST.hex(' ').upper()}" in caplog.text) == (reader == "log")
