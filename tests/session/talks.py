"""Random talks over one exchange: every kind of request, received bytes, write and time."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil, inf
from random import Random

from cobotwire.codec.interface import Codec
from cobotwire.protocol.addresses import addresses_of
from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.protocol.fields import Field, RawRows, Variant
from cobotwire.protocol.numbers import Number
from cobotwire.protocol.table import Command
from cobotwire.session import EncodedRequest, Exchange, Pending, PendingRequest, RetryPolicy
from cobotwire.session.events import SessionEvent, as_traffic
from cobotwire.session.request import RequestEncoder

# A tick is exact as a float and in nanoseconds. No time constant of the exchange is a multiple of
# it, so no event coincides with a deadline.
TICK = 1 / 512
LINK_ERROR = LinkError("port", "gone")


class Talk:
    """Plays the steps of one talk; the seed of each step decides its details."""

    def __init__(self, codec: Codec, seed: int) -> None:
        self._codec, self._table = codec, codec.table
        self._dice = Random(seed)
        self.now = self._dice.randrange(5000) * TICK
        self.exchange = Exchange(codec)
        self._sent: list[EncodedRequest] = []
        self._pending: list[Pending] = []
        self._to = [None, *addresses_of(self._table)]
        self._commands = self._chosen()
        # How many bytes were received, and how many of them were in events.
        self._received = self._covered = 0

    def step(self, name: str, seed: int) -> None:
        """Play one step."""
        self._dice = Random(seed)
        step: Callable[[], None] = getattr(self, f"_{name}")
        step()

    def finish(self) -> None:
        """Let time pass until nobody waits; check that each byte was in one event."""
        for _ in range(100 + 10 * len(self._pending)):
            if not self.exchange.busy:
                break
            self.now += max(self.exchange.idle_seconds(self.now) or 0.0, TICK)
            self._cover(self.exchange.advance(b"", self.now))
            self.exchange.outgoing(self.now, drained=True)
        assert not self.exchange.busy, "a request waits without end"
        self._lose()
        assert self._covered == self._received

    def _cover(self, events: list[SessionEvent]) -> None:
        found = (as_traffic(event, self.now) for event in events)
        self._covered += sum(len(traffic.data) for traffic in found if traffic)

    def _chosen(self) -> list[Command]:
        """Return a few commands; those that share an id are chosen together."""
        dice, commands = self._dice, self._table.commands
        queries = [command for command in commands if command.requires_reply] or commands
        rare = [c for c in commands if c.text or c.request_text or c.event or c.accepted]
        # The reply to such a query may have the bytes of its request.
        alike = [c for c in queries if {v.size for v in c.request} & {v.size for v in c.reply}]
        pools = (queries, commands, dice.choice([rare, alike, queries]) or commands)
        ids = {dice.choice(pool).id for pool in pools}
        return [command for command in commands if command.id in ids]

    # What callers do.

    def _call(self) -> None:
        dice, command = self._dice, self._dice.choice(self._commands)
        if self._sent and dice.random() < 0.5:
            request = dice.choice(self._sent)
        elif (encoded := self._encoded(command)) is not None:
            request = encoded
        else:
            return
        self._sent.append(request)
        ends_by = dice.choice([inf, inf, self.now + self._span()])
        if request.command.requires_reply:
            attempts, shortest = dice.choice([(1, 0.125), (3, 0.1), (4, TICK), (4, TICK)])
            policy = RetryPolicy(attempts, shortest, dice.choice([1.0, 0.25, 0.0]))
            wait = dice.choice([None, None, self._span(), 0.25, 0.75])
            pending = PendingRequest(request, wait, policy, self.now, ends_by)
            self._pending.append(pending)
            self.exchange.enqueue(pending)
            return
        within = dice.choice([None, 0.25, self._span()])
        data, ack = self.exchange.send_one_way(request, self.now, within, ends_by)
        self._pending += [ack] if ack else []
        self._write(data)

    def _encoded(self, command: Command) -> EncodedRequest | None:
        if not command.request:  # the device sends it by itself
            return None
        dice, variant = self._dice, self._dice.randrange(len(command.request))
        rows = self._rows(command.request[variant])
        data = command.request[variant].pack(rows)
        values = self._codec.decode(
            "request", self._table.frame.enclose(command.id, data), of=command.name
        ).values
        form = command.request_text
        words = ["", "a", "b c", "ä", *(form.prefixes if form else ())]
        texts = {name: dice.choice(words) for name in (form.fields if form else ())}
        try:
            encoder = RequestEncoder(self._codec, dice.choice(self._to))
            return encoder.encode(command.name, values, texts, variant)
        except UsageError:
            return None

    def _give_up(self) -> None:
        if self._pending:
            self.exchange.give_up(self._dice.choice(self._pending))

    # What the client's loop does.

    def _turn(self) -> None:
        drained = self._dice.random() < 0.8
        if not drained:
            # Unread bytes hold a request back for 50 ms, so it waits for 25 ticks, but not for 26.
            self._write(self.exchange.outgoing(self.now, drained))
            self.now += self._dice.choice([0, 25, 26]) * TICK
        self._write(self.exchange.outgoing(self.now, drained))

    def _write(self, request: bytes) -> None:
        """Write a request whole, or only a part of it."""
        if not request:
            return
        alignment, how = self.exchange.alignment, self._dice.random()
        align = alignment.align
        if how < 0.9:
            if align:
                alignment.end()
        elif how < 0.94:
            alignment.cut(align, request, self._dice.randrange(len(align + request)))
            self.exchange.fail_waiting(LINK_ERROR)
        elif how < 0.95:
            alignment.cut(align, request, None)
        else:
            self._wait()
            last = self.exchange.sent_last
            if last is not None and last.attempt_times:
                self.exchange.written(last, self.now)

    def _wait(self) -> None:
        idle = self.exchange.idle_seconds(self.now)
        until_next = ceil((self.now + (idle or 0.0)) / TICK) * TICK - self.now
        self.now += self._dice.choice([until_next, until_next, self._span()])

    def _span(self) -> float:
        dice = self._dice
        spans = [0, 1, 2, 8, 16, 64, dice.randrange(64), dice.choice([128, 512, 600, 31000])]
        return TICK * dice.choice(spans)

    def _wake(self) -> None:
        self._wait()
        dice, exchange = self._dice, self.exchange
        self._cover(dice.choice([exchange.wake, exchange.wake, exchange.end_overdue])(self.now))
        exchange.note_full(dice.random() < 0.3)
        if dice.random() < 0.7:
            self._turn()

    def _lose(self) -> None:
        self._cover(self.exchange.fail(LINK_ERROR, self.now))

    def _reopen(self) -> None:
        state = self.exchange.persist(self.now)
        self.exchange = Exchange(self._codec)
        self.exchange.restore(state)
        self._pending.clear()
        self._received = self._covered = 0

    # What the line brings.

    def _arrive(self) -> None:
        dice, data = self._dice, self._bytes()
        how = dice.randrange(8)
        if how == 0:
            data += data
        elif how == 1:
            data = data[: dice.randrange(len(data) + 1)] + dice.choice([b"", self._bytes()])
        elif how == 2 and data:
            at = dice.randrange(len(data))
            data = data[:at] + dice.randbytes(1) + data[at + 1 :]
        elif how == 3:
            data = dice.randbytes(dice.randrange(4)) + data + self._bytes()
        cut = dice.choice([0, 0, dice.randrange(len(data) + 1)])
        if cut:
            self._cover(self.exchange.receive(data[:cut], self.now))
            self.now += dice.choice([0.0, self._span()])
        self._cover(self.exchange.advance(data[cut:], self.now))
        self._received += len(data)

    def _bytes(self) -> bytes:
        dice = self._dice
        last = self.exchange.sent_last
        request = dice.choice(self._sent[-4:]) if self._sent else None
        if last is not None and not last.done and dice.random() < 0.7:
            request = last.request
        if request is None or dice.random() < 0.1:
            return self._reply(dice.choice(self._commands), None)
        if dice.random() < 0.2:
            return request.frame
        return self._reply(request.command, request)

    def _reply(self, command: Command, request: EncodedRequest | None) -> bytes:
        """Return a reply of a command, usually with the values that echo its request."""
        dice, frame = self._dice, self._table.frame
        if command.text is not None:
            parts = [prefix + dice.choice(["", "a b"]) for prefix in command.text.prefixes]
            return ("".join(parts) + command.text.suffix).encode() + dice.choice([b"", b"\r\n"])
        if not command.reply:
            return dice.randbytes(3)
        variant = dice.choice(command.reply)
        rows: RawRows = self._rows(variant)
        address = dice.choice([*frame.addresses, None])
        if request is not None and dice.random() < 0.8:
            message = self._codec.decode("request", request.frame, of=command.name)
            sent = dict(zip(message.variant.names, self._raw(request.frame, message.variant)))
            rows = [
                sent.get(field.name, row) if field.echo else row
                for field, row in zip(variant.fields, rows)
            ]
            address = message.address
        data = variant.pack(rows)
        if data and dice.random() < 0.1:
            data = data[:-1] + dice.randbytes(1)
        return frame.enclose(command.id, data, address, "reply")

    def _raw(self, frame: bytes, variant: Variant) -> RawRows:
        return variant.unpack(self._table.frame.data(frame))

    def _rows(self, variant: Variant) -> list[list[int]]:
        rows: list[list[int]] = [[] for _ in variant.fields]
        # In this order, a selector precedes the field that it selects.
        order = sorted(range(len(rows)), key=lambda index: variant.fields[index].selector >= 0)
        for index in order:
            field = variant.fields[index]
            case = variant.raw_case(field, rows) or field.cases[0]
            rows[index] = [self._number(field, number) for number in case.numbers]
        return rows

    def _number(self, field: Field, number: Number) -> int:
        choices = field.choices or number.choices
        if field.kind == "text":
            return self._dice.choice(b"ab")
        if choices:
            return self._dice.choice(choices)
        low, high = number.minimum, number.maximum
        near = [raw for raw in (0, 1, 2) if low <= raw <= high]
        return self._dice.choice([low, high, *near, *near])
