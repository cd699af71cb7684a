"""Code that the interpreter runs in the middle of a call, such as that of another thread.

Native code can be interrupted where Python objects are made: making one may start a collection of
garbage, which runs callbacks, and these let other threads run. So a callback at each collection,
and a collection at each object, try every such place.
"""

from __future__ import annotations

import gc
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from cobotwire import MyCobot
from cobotwire.codec import CodecName
from cobotwire.codec.interface import Codec
from scripted_peer import ScriptedPeer

SERVO = bytes.fromhex("FF FF 01 04 02 38 02 BE")
TEXT = b"cmd_len error\r\n"
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
STOP = bytes.fromhex("FE FE 02 29 FA")


@contextmanager
def at_each_collection(call: Callable[[], None]) -> Iterator[None]:
    """Collect garbage whenever an object is made that can be part of a cycle; call a function."""
    me = threading.get_ident()

    def run(phase: str, info: dict[str, int]) -> None:
        if phase == "start" and threading.get_ident() == me:
            call()

    before = gc.get_threshold()
    gc.callbacks.append(run)
    gc.set_threshold(1, 1000, 1000)
    try:
        yield
    finally:
        gc.set_threshold(*before)
        gc.callbacks.remove(run)


def test_counts_of_a_framer_can_be_read_at_any_time(codec: Codec) -> None:
    framer = codec.framer("reply")
    chunk = (SERVO + POWERED + TEXT) * 20
    seen: list[object] = []

    def read() -> None:
        try:
            seen.append(framer.fed >= framer.pending >= 0 and framer.counters.bytes <= framer.fed)
        except RuntimeError as error:
            seen.append(error)

    with at_each_collection(read):
        for data in (chunk, memoryview(chunk), b"\xfe\xfe"):
            framer.feed(data)
        framer.flush()
    assert len(seen) > 20
    assert set(seen) == {True}
    assert framer.fed == 2 * len(chunk) + 2


@pytest.mark.parametrize("name", ["native", "reference"])
def test_stop_of_another_thread_is_sent_in_the_middle_of_a_query(name: CodecName) -> None:
    wanted, sent = threading.Event(), threading.Event()
    failures: list[BaseException] = []
    stops = 0
    over = False

    def stop() -> None:
        nonlocal stops
        while not over:
            wanted.wait()
            wanted.clear()
            if over:
                break
            try:
                arm.stop()
                stops += 1
            except BaseException as error:
                failures.append(error)
            sent.set()

    def let_it_stop() -> None:
        # Where this thread holds a lock that stop() needs, that goes on later.
        sent.clear()
        wanted.set()
        sent.wait(0.01)

    script: list[bytes | float | None] = [SERVO + TEXT, 0.001, SERVO + POWERED]
    with ScriptedPeer(*[script] * 400) as peer, MyCobot(peer.url, timeout=2, codec=name) as arm:
        stopping = threading.Thread(target=stop)
        stopping.start()
        with at_each_collection(let_it_stop):
            for _ in range(2):
                assert arm.is_power_on() is True
        over = True
        wanted.set()
        stopping.join()
        arm.is_power_on()
    assert failures == []
    assert stops > 10
    assert peer.received.count(STOP) == stops
