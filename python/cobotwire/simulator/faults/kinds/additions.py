"""Faults that lose nothing, but add bytes that the arm did not send."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Literal

from cobotwire.simulator.faults.exchange import Piece, Reply, enlarged, followed_by, joined
from cobotwire.simulator.faults.fault import ONLY, Context, Damage, Fault, Only
from cobotwire.simulator.faults.noise import COMMAND_ERROR, LEAKS, NOISE, mixed_noise
from cobotwire.simulator.faults.registry import kind
from cobotwire.simulator.faults.rules import (
    SECONDS,
    Several,
    integer,
    one_of,
    optional,
    pairs_of_hex,
    ruled,
)

Where = Literal["before", "inside", "after"]
TIMES = integer(1, 1000)


@dataclass(frozen=True, slots=True, kw_only=True)
class Addition(Damage):
    """Bytes are added.

    Attributes:
        where: before the reply, after it, or inside, which breaks it.
        after_bytes: with ``inside``, the number of bytes before them; None: random.
        times: how many times, without a pause.
    """

    where: Where = ruled(one_of(("before", "inside", "after")), "before")
    after_bytes: int | None = ruled(optional(integer(1, 4096)), None)
    times: int = ruled(TIMES, 1)

    @abstractmethod
    def drawn(self, context: Context) -> bytes:
        """Return the bytes to add once."""

    def spoil(self, data: bytes, context: Context) -> bytes:
        """Add the bytes. If the data is too short for ``inside``, add them after it."""
        cut, added = self._addition(len(data), context)
        return data[:cut] + added + data[cut:]

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Add the bytes to a reply; its pauses stay where they are."""
        if self.of == "request":
            return reply
        return enlarged(reply, *self._addition(len(joined(reply)), context))

    def _addition(self, size: int, context: Context) -> tuple[int, bytes]:
        """Return after how many of ``size`` bytes to add, and the bytes to add."""
        added = b"".join(self.drawn(context) for _ in range(self.times))
        cut = {"before": 0, "after": size}.get(self.where, self.after_bytes or 0)
        if self.where == "inside" and not cut and size > 1:
            cut = context.random.randrange(1, size)
        shown = added.hex(" ").upper() if len(added) <= 32 else f"{len(added)} bytes"
        context.report(f"{shown} {self.where} the {self.of}")
        return min(cut, size), added


@kind("inserted")
@dataclass(frozen=True, slots=True, kw_only=True)
class Inserted(Addition):
    """Bytes of your choice are added: another command's frame, another program's request.

    Attributes:
        data: the bytes.
    """

    data: bytes = ruled(pairs_of_hex, b"\x00")

    def drawn(self, context: Context) -> bytes:
        """Return the bytes as they are."""
        return self.data


@kind("noise")
@dataclass(frozen=True, slots=True, kw_only=True)
class Noise(Addition):
    """Noise of the catalogue is added, also where nothing is replied.

    Attributes:
        classes: which classes of noise, each equally often; empty: all, by their weights.
    """

    wants_reply = False

    classes: tuple[str, ...] = ruled(Several(one_of(NOISE)), ())

    def drawn(self, context: Context) -> bytes:
        """Draw a piece of noise."""
        if not self.classes:
            return mixed_noise(context.random, context.table)
        return NOISE[context.random.choice(self.classes)].draw(context.random, context.table)

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Add the noise; if there is no reply, send only the noise."""
        if reply or self.of == "request":
            # Not super(): a dataclass with slots is a new class, which super() does not know.
            return Addition.change_reply(self, reply, context)
        return (Piece(0.0, self._addition(0, context)[1]),)


@kind("servo-leak")
@dataclass(frozen=True, slots=True, kw_only=True)
class ServoLeak(Addition):
    """Packets of the servo bus are added, as they were seen on real lines.

    Attributes:
        packets: which ones; of several, one is drawn each time.
    """

    packets: tuple[str, ...] = ruled(Several(one_of(LEAKS), empty=False), tuple(LEAKS))

    def drawn(self, context: Context) -> bytes:
        """Draw one of the packets."""
        return LEAKS[context.random.choice(self.packets)]


@kind("command-error")
@dataclass(frozen=True, slots=True, kw_only=True)
class CommandError(Fault):
    """The firmware replies ``cmd_len error``, by default only to malformed input.

    Attributes:
        times: how many times.
        seconds: the pause between two of them, and before the reply, which follows.
    """

    wants_reply = False

    only: Only = ruled(one_of(ONLY), "malformed input")
    times: int = ruled(TIMES, 1)
    seconds: float = ruled(SECONDS, 0.0)

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Send the text before the reply, if there is one."""
        context.report(f"{COMMAND_ERROR.decode().strip()}, {self.times} times")
        texts = tuple(Piece(self.seconds if n else 0.0, COMMAND_ERROR) for n in range(self.times))
        return followed_by(texts, self.seconds, reply)


@kind("duplicated")
@dataclass(frozen=True, slots=True, kw_only=True)
class Duplicated(Fault):
    """The reply is sent twice.

    Attributes:
        seconds: how much later the copy comes; 0: in one piece with the reply. Other replies may
            come between them.
    """

    seconds: float = ruled(SECONDS, 0.0)

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Send the reply twice."""
        context.report(f"again after {self.seconds:g} s")
        if self.seconds:
            context.put_later(self.seconds, reply)
            return reply
        return (*reply[:-1], Piece(reply[-1].pause, reply[-1].data + joined(reply)))


@kind("echo")
@dataclass(frozen=True, slots=True, kw_only=True)
class Echo(Fault):
    """The host's own bytes come back before the reply.

    Attributes:
        seconds: the pause between the echo and the reply.
    """

    wants_reply = False
    continues = True

    seconds: float = ruled(SECONDS, 0.0)

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Send the request, then the reply."""
        context.report(f"{len(context.request.data)} bytes of the host come back")
        return followed_by((Piece(0.0, context.request.data),), self.seconds, reply)
