"""Forward bytes between a program and an arm in this process: all, or only what a guard permits."""

from __future__ import annotations

import fcntl
import io
import os
import select
import socket
import tempfile
import threading
import time
import tty
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.capture import CaptureWriter, Interface, Packet
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.inspect.following import FollowedRecording
from cobotwire.inspect.tap.copies import PIECE, Copies, Copy, CopyReader
from cobotwire.inspect.tap.forwarder import Forwarder
from cobotwire.inspect.tap.guard import Guard, is_harmless
from cobotwire.inspect.tap.program_ends import ProgramEnd, PtyEnd, TcpEnd
from cobotwire.protocol.errors import CaptureError, LinkError, ProtocolError
from cobotwire.transport import open_transport
from strategies import chunked, streams

SECONDS = 10.0
QUERY, MOTION = bytes.fromhex("FE FE 02 20 FA"), bytes.fromhex("FE FE 05 21 01 00 00 32 FA")
STOP = bytes.fromhex("FE FE 02 29 FA")


class Tap:
    """A forwarder in a thread; ``arm`` is the arm's end of the line."""

    def __init__(self, program: ProgramEnd, guard: Guard | None = None) -> None:
        self.arm, slave = os.openpty()
        tty.setraw(slave)
        self.slave = slave
        self._reading, writing = os.pipe()
        self._reader = CopyReader()
        port = open_transport(os.ttyname(slave), 115200)
        self.url = program.url
        self.forwarder = Forwarder(port, program, Copies(writing), guard)
        self.failure: list[LinkError] = []
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        try:
            self.forwarder.serve()
        except LinkError as error:
            self.failure.append(error)

    def copies(self) -> list[Copy]:
        """Return what was copied since the last call."""
        found: list[Copy] = []
        while select.select([self._reading], [], [], 0)[0]:
            found += self._reader.feed(os.read(self._reading, 1 << 20))
        return found

    def until(self, note: str) -> None:
        """Wait for a note; what was copied before it is forgotten."""
        end = time.monotonic() + SECONDS
        while not any(note in copy.data.decode("latin-1") for copy in self.copies()):
            assert time.monotonic() < end, note
            time.sleep(0.005)

    def close(self) -> None:
        """Stop it, unless it has ended; release everything."""
        os.write(self.forwarder.stopper, b"x")
        self._thread.join(SECONDS)
        assert not self._thread.is_alive()
        self.forwarder.close()
        for descriptor in (self.arm, self.slave, self._reading):
            os.close(descriptor)


@contextmanager
def opened(url: str) -> Iterator[int]:
    """Open a port as a program does that sets it up itself."""
    port = os.open(url, os.O_RDWR | os.O_NOCTTY)
    try:
        yield port
    finally:
        os.close(port)


def received(port: int, size: int) -> bytes:
    """Return ``size`` bytes, and what comes right after them."""
    data, end = b"", time.monotonic() + SECONDS
    while time.monotonic() < end:
        wait = 0.02 if len(data) >= size else SECONDS
        if not select.select([port], [], [], wait)[0]:
            break
        data += os.read(port, 4096)
    return data


@pytest.fixture
def tap() -> Iterator[Tap]:
    with closing(Tap(PtyEnd())) as made:
        yield made


CHUNKS = st.lists(st.tuples(st.booleans(), st.binary(min_size=1, max_size=300)), max_size=12)


def test_every_byte_passes_unchanged_both_ways(tap: Tap) -> None:
    with opened(tap.url) as program:
        tap.until("opened")

        @settings(max_examples=40)
        @given(CHUNKS)
        def check(chunks: list[tuple[bool, bytes]]) -> None:
            for from_program, data in chunks:
                os.write(program if from_program else tap.arm, data)
            sent, replied = (
                b"".join(data for way, data in chunks if way is from_program)
                for from_program in (True, False)
            )
            at_arm, at_program = b"", b""
            while (len(at_arm), len(at_program)) < (len(sent), len(replied)):
                ready = select.select([tap.arm, program], [], [], SECONDS)[0]
                assert ready
                at_arm += os.read(tap.arm, 4096) if tap.arm in ready else b""
                at_program += os.read(program, 4096) if program in ready else b""
            assert (at_arm, at_program) == (sent, replied)

        check()
        # Nothing is added after the last byte, either.
        assert select.select([tap.arm, program], [], [], 0.05)[0] == []


def test_program_that_writes_faster_than_the_arm_reads_waits_and_loses_nothing(tap: Tap) -> None:
    data = os.urandom(200_000)
    with opened(tap.url) as program:
        writer = threading.Thread(target=os.write, args=(program, data))
        writer.start()
        time.sleep(0.1)
        assert writer.is_alive()
        assert received(tap.arm, len(data)) == data
        writer.join()
    copies = tap.copies()
    assert b"".join(copy.data for copy in copies if copy.kind == "sent") == data


def test_unread_replies_are_not_left_for_the_next_program(tap: Tap) -> None:
    with opened(tap.url) as program:
        os.write(program, QUERY)
        assert received(tap.arm, len(QUERY)) == QUERY
        os.write(tap.arm, b"unread")
        select.select([program], [], [], SECONDS)
    tap.until("closed")
    # No program has the port open, so this is lost, as on a serial port.
    os.write(tap.arm, b"lost")
    while b"lost" not in b"".join(copy.data for copy in tap.copies()):
        pass
    with opened(tap.url) as program:
        tap.until("opened")
        os.write(tap.arm, b"new")
        assert received(program, 3) == b"new"


def test_unplugged_arm_ends_the_forwarder_and_hangs_up_the_program(tap: Tap) -> None:
    with opened(tap.url) as program:
        os.write(program, QUERY)
        assert received(tap.arm, len(QUERY)) == QUERY
        os.close(tap.arm)
        tap._thread.join(SECONDS)
        [error] = tap.failure
        assert "cannot be read" in str(error)
        tap.forwarder._program.close()
        with pytest.raises(OSError, match="Input/output error"):
            os.write(program, QUERY)
    tap.forwarder._program = PtyEnd()
    tap.arm = os.dup(tap.slave)


def test_second_program_over_tcp_is_disconnected_and_the_first_one_is_served() -> None:
    with closing(Tap(TcpEnd("127.0.0.1", 0))) as tap:
        address = "127.0.0.1", int(tap.url.rpartition(":")[2])
        with socket.create_connection(address) as first:
            first.sendall(QUERY)
            assert received(tap.arm, len(QUERY)) == QUERY
            with socket.create_connection(address) as second:
                assert second.recv(1) == b""
            os.write(tap.arm, b"reply")
            assert first.recv(5) == b"reply"
        tap.until("closed")
        with socket.create_connection(address) as next_one:
            next_one.sendall(STOP)
            assert received(tap.arm, len(STOP)) == STOP


def test_read_only_tap_passes_no_motion_and_drops_half_a_request_of_the_last_program() -> None:
    codec = codecs.load(TABLE)
    with closing(Tap(PtyEnd(), Guard(codec))) as tap:
        with opened(tap.url) as program:
            os.write(program, QUERY + MOTION + b"noise" + STOP + QUERY[:3])
            assert received(tap.arm, len(QUERY + STOP)) == QUERY + STOP
        tap.until("closed")
        with opened(tap.url) as program:
            os.write(program, QUERY[3:] + QUERY)
            assert received(tap.arm, len(QUERY)) == QUERY
            # A request may come in pieces, while the arm sends.
            for piece in (QUERY[:3], QUERY[3:]):
                os.write(program, piece)
                time.sleep(0.01)
                os.write(tap.arm, b"x")
                assert received(program, 1) == b"x"
            assert received(tap.arm, len(QUERY)) == QUERY
            # A pause ends an incomplete request, as at the arm.
            os.write(program, QUERY[:4])
            time.sleep(0.3)
            os.write(program, QUERY[4:] + STOP)
            assert received(tap.arm, len(STOP)) == STOP
        held = b"".join(copy.data for copy in tap.copies() if copy.kind == "held")
        assert held == QUERY[3:] + QUERY


def _is_harmless(codec: Codec, data: bytes) -> bool:
    try:
        return is_harmless(codec.decode("request", data).command)
    except ProtocolError:
        return False


@pytest.mark.parametrize("name", ["mycobot280", "mybuddy", "myarm300"])
def test_guard_passes_whole_queries_and_stops_of_an_edition_and_no_other_byte(name: str) -> None:
    table = editions.load(name).TABLE
    codec = codecs.load(table)

    @settings(max_examples=15)
    @given(st.data())
    def check(drawn: st.DataObject) -> None:
        data = drawn.draw(streams(table))
        guard = Guard(codec)
        decisions = [d for chunk in drawn.draw(chunked(data)) for d in guard.feed(chunk)]
        decisions += guard.flush()
        assert b"".join(decision.data for decision in decisions) == data
        framer = codec.framer("request")
        frames = [event.data for event in framer.feed(data) + framer.flush()]
        passed = [decision.data for decision in decisions if decision.passes]
        assert passed == [data for data in frames if _is_harmless(codec, data)]

    check()


def test_only_queries_and_stops_are_harmless() -> None:
    others = {c.name for c in TABLE.commands if c.safety != "query" and is_harmless(c)}
    assert others == {"stop", "clear_queue", "jog_stop"}


@given(st.lists(st.binary(min_size=1, max_size=2 * PIECE), max_size=60), st.integers(1, 5000))
@settings(max_examples=30)
def test_copies_arrive_whole_or_are_counted(parts: list[bytes], read_size: int) -> None:
    reading, writing = os.pipe()
    os.set_blocking(reading, False)
    copies, reader, found = Copies(writing), CopyReader(), list[Copy]()
    fcntl.fcntl(writing, fcntl.F_SETPIPE_SZ, 4096)
    for number, part in enumerate(parts):
        copies.put("sent", part, float(number))
        if number % 4 == 0:
            found += reader.feed(os.read(reading, read_size))
    closing_thread = threading.Thread(target=copies.close)
    closing_thread.start()
    os.set_blocking(reading, True)
    while data := os.read(reading, read_size):
        found += reader.feed(data)
    closing_thread.join()
    os.close(reading)
    dropped = sum(int(copy.data) for copy in found if copy.kind == "dropped")
    seen = [copy.data for copy in found if copy.kind == "sent"]
    assert sum(map(len, seen)) + dropped == sum(map(len, parts))
    if not dropped:
        assert b"".join(seen) == b"".join(parts)


@given(st.data())
@settings(max_examples=40)
def test_followed_recording_with_random_bytes_is_refused_or_ends_without_traffic(
    drawn: st.DataObject,
) -> None:
    recorded = io.BytesIO()
    writer = CaptureWriter(recorded)
    packet = Packet(0, "received", QUERY, interface=writer.interface(Interface("arm", "mycobot")))
    writer.packet(packet)
    begin = drawn.draw(st.sampled_from([0, 4, 60, len(recorded.getvalue())]))
    with tempfile.NamedTemporaryFile() as file, pytest.MonkeyPatch.context() as patch:
        patch.setattr("cobotwire.inspect.following.HEAD_SECONDS", 0.0)
        patch.setattr("cobotwire.inspect.following.WAIT_SECONDS", 0.001)
        file.write(recorded.getvalue()[:begin] + drawn.draw(st.binary(max_size=100)))
        file.flush()
        with suppress(CaptureError), FollowedRecording(f"follow:{file.name}", "pro450") as followed:
            assert followed.table.edition == "mycobot"
            while not (followed._file.at_end or followed.problem):
                time.sleep(0.001)
            assert followed.take() == []
