"""Devices that lose a setting after malformed input, or reply with what was true before."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.conformance.device.requests import gentle
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Command, Table
from cobotwire.session.request import RequestEncoder
from mutation.device.broken import BrokenArm, Fault, TimedBytes
from mutation.device.exchanges import distinct
from mutation.device.stimulus import STIMULI, Stimulus
from mutation.mutant import Mutant


class Forgets(Fault):
    """After some malformed input, one setting has its plainest value again."""

    def __init__(self, after: Stimulus, request: bytes) -> None:
        self._after = after
        self._request = request

    def forgets(self, kind: Stimulus) -> bytes:
        """Return the request that sets the plainest value."""
        return self._request if kind == self._after else b""


class Stale(Fault):
    """One query gets the reply to the same query before, to the same address."""

    def __init__(self, command: Command) -> None:
        self._command = command
        self._before: dict[int | None, bytes] = {}

    def reply(self, codec: Codec, request: DecodedMessage, data: bytes) -> list[TimedBytes]:
        """Return the reply before; the first time, the right one."""
        if request.command is not self._command:
            return [TimedBytes(0.0, data)]
        sent = self._before.get(request.address) or data
        self._before[request.address] = data
        return [TimedBytes(0.0, sent)]


def loses_state(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for each setting that a query reads, and each kind of malformed input."""
    encoder = RequestEncoder(codecs.load(table), None)
    for command in distinct(table):
        if command.safety != "setting" or command.read_by is None or command.request_text:
            continue
        try:
            data = encoder.encode_request(gentle(command)).frame
        except UsageError:
            continue
        for after in STIMULI:
            yield _forgetting(table, command, after, data)


def stale_replies(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for each query."""
    for command in distinct(table):
        if command.safety == "query" and command.requires_reply:
            yield _stale(table, command)


def _forgetting(table: Table, command: Command, after: Stimulus, data: bytes) -> Mutant:
    return Mutant(
        "state lost",
        command.name,
        "",
        f"after {after}",
        lambda clock: BrokenArm(table, Forgets(after, data), clock),
    )


def _stale(table: Table, command: Command) -> Mutant:
    return Mutant(
        "stale reply",
        command.name,
        "",
        "that to the query before",
        lambda clock: BrokenArm(table, Stale(command), clock),
    )
