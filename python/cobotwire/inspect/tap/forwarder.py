"""Forward bytes between a program and an arm: a small loop that waits for nothing else."""

from __future__ import annotations

import gc
import select
import socket
import time
from collections.abc import Callable, Sequence
from contextlib import suppress

from cobotwire.inspect.tap.copies import Copies
from cobotwire.inspect.tap.guard import Decision, Guard
from cobotwire.inspect.tap.program_ends import ProgramEnd
from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.simulator.peer import IDLE_SECONDS
from cobotwire.transport.interface import OpenedTransport

# Bytes that wait in each direction. If more bytes wait, nothing is read, as with a full serial
# port: a program that writes too fast waits, and replies that nobody reads stay in the system.
MOST_WAITING = 4096


def check_pollable(arm: OpenedTransport) -> int:
    """Return the descriptor of the arm's port.

    Raises:
        UsageError: the system cannot wait for it.
    """
    descriptor = arm.fileno()
    if descriptor is None:
        message = f"tap needs a serial port or socket://HOST:PORT, not {arm.url}"
        raise UsageError("port", arm.url, message=message)
    return descriptor


class Forwarder:
    """Forwards until a byte is written to ``stopper``, or until the arm's port is gone.

    Without a guard every byte is forwarded as soon as it is read. While no program has the port
    open, bytes from the arm are copied but not delivered, as on a closed serial port.
    """

    def __init__(
        self, arm: OpenedTransport, program: ProgramEnd, copies: Copies, guard: Guard | None
    ) -> None:
        """Own ``arm``, ``program`` and ``copies``; raise as :func:`check_pollable`."""
        self.url = program.url
        self._descriptor = check_pollable(arm)
        self._arm, self._program, self._copies, self._guard = arm, program, copies, guard
        self._to_arm, self._to_program = bytearray(), bytearray()
        self._give_up_at = 0.0
        self._stop, self._stopper = socket.socketpair()
        self._stopper.setblocking(False)

    @property
    def stopper(self) -> int:
        """The descriptor for ``signal.set_wakeup_fd``: a byte written to it ends :meth:`serve`."""
        return self._stopper.fileno()

    def serve(self, callbacks: Sequence[Callable[[], None]] = ()) -> None:
        """Forward; at the end write to the arm what was read from the program.

        Raises:
            LinkError: the arm's port is gone.
        """
        # A garbage collection that visits all imported objects takes milliseconds.
        gc.freeze()
        while self._turn():
            pass
        # What was read is written, so that the end cuts no request.
        if self._to_arm:
            with suppress(LinkError):
                self._arm.write(bytes(self._to_arm))
                self._copies.put("sent", bytes(self._to_arm), time.monotonic())

    def close(self) -> None:
        """Close both ends and the copies."""
        self._arm.close()
        self._program.close()
        self._copies.close()
        self._stop.close()
        self._stopper.close()

    def _turn(self) -> bool:
        """Wait, read and write once; return False if it was stopped."""
        program = self._program
        reading, writing = [self._stop.fileno()], []
        if program.arrivals is not None:
            reading.append(program.arrivals)
        if len(self._to_program) < MOST_WAITING:
            reading.append(self._descriptor)
        if self._to_arm:
            writing.append(self._descriptor)
        if program.descriptor is not None:
            if len(self._to_arm) < MOST_WAITING:
                reading.append(program.descriptor)
            if self._to_program:
                writing.append(program.descriptor)
        # A request that the program does not complete is given up, as arms do.
        pending = self._guard is not None and self._guard.pending
        ready, writable, _ = select.select(reading, writing, [], IDLE_SECONDS if pending else None)
        if self._stop.fileno() in ready:
            return False
        if program.descriptor in ready or program.descriptor in writable:
            self._exchange_with_program()
        if self._descriptor in ready or self._descriptor in writable:
            self._exchange_with_arm()
        if program.arrivals in ready:
            self._note_program(*program.arrive())
        if self._guard and pending and time.monotonic() >= self._give_up_at:
            self._decide(self._guard.flush())
        return True

    def _exchange_with_program(self) -> None:
        data = self._program.read() if len(self._to_arm) < MOST_WAITING else None
        if data:
            if self._guard is None:
                self._to_arm += data
            else:
                self._give_up_at = time.monotonic() + IDLE_SECONDS
                self._decide(self._guard.feed(data))
            self._write_to_arm()
        elif data is not None:
            self._note_program("the program closed the port", new=True)
        self._write_to_program()

    def _exchange_with_arm(self) -> None:
        self._write_to_arm()
        if len(self._to_program) >= MOST_WAITING:
            return
        data = self._arm.read(0.0)
        if data:
            now = time.monotonic()
            self._to_program += data
            self._write_to_program()
            self._copies.put("received", data, now)

    def _write_to_arm(self) -> None:
        if self._to_arm:
            taken = self._arm.write_some(bytes(self._to_arm))
            self._copies.put("sent", bytes(self._to_arm[:taken]), time.monotonic())
            del self._to_arm[:taken]

    def _write_to_program(self) -> None:
        if self._to_program:
            del self._to_program[: self._program.write(bytes(self._to_program))]

    def _decide(self, decisions: Sequence[Decision]) -> None:
        for decision in decisions:
            if decision.passes:
                self._to_arm += decision.data
            else:
                self._copies.put("held", decision.data, time.monotonic())

    def _note_program(self, happened: str, new: bool) -> None:
        """Note what happened; discard the unread replies and half a request of an old program."""
        if new:
            self._to_program.clear()
            self._decide(self._guard.flush() if self._guard else ())
        if happened:
            self._note(happened)

    def _note(self, text: str) -> None:
        self._copies.put("note", text.encode(), time.monotonic())
