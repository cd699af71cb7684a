"""Sends malformed requests, and checks that they get no reply and do no harm."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from cobotwire.conformance.device.kept_state import KeptState, Malformed
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.response import Response
from cobotwire.conformance.suite import TestCase
from cobotwire.protocol.messages import Reply, Request
from cobotwire.session.request import EncodedRequest

RECOVERS = TestCase("recovers", "After a malformed request, the next good one is replied to.")
KEPT = TestCase("state-kept", "A malformed request changes nothing that a query reads.")

# How many changed values a failure names.
MOST_CHANGES = 4
# Test cases with many values that are malformed in the same way.
ONE_KIND = ("unknown-id", "out-of-range")


class MalformedSender:
    """Sends malformed requests that are made from one good request.

    A correct device that finds the next frame at once needs no pauses. So a good query of another
    command follows at once; if only its reply comes, the device passes. Otherwise the tester sends
    the request again, and waits until the device must have given up. It also waits after the first
    malformed request of each kind.
    """

    def __init__(self, probe: Probe, request: EncodedRequest) -> None:
        self._probe = probe
        self._device = probe.device
        self._request = request
        self._kept = probe.run.kept = probe.run.kept or KeptState(self._device)
        self._lost = False

    def send(self, case: TestCase, what: str, data: bytes) -> None:
        """Send a malformed request; the firmware may send an error text, but no reply."""
        kind = case.id if case.id in ONE_KIND else what
        known = kind in self._kept.tried_with_pauses
        query = self._kept.next_query(other_than=self._request.command.id)
        at_once = known and self._kept.resyncs and query is not None
        reply = self._reply_after(what, data, query) if query is not None and at_once else None
        if query is not None and reply is not None:
            self._probe.expect(case, True, "")
            self._probe.expect(RECOVERS, True, "")
            self.expect_kept(what, data, partial(self._reply_after, what, data, query), reply)
        else:
            self._kept.tried_with_pauses.add(kind)
            passed = self._send_and_wait(case, what, data)
            self._kept.resyncs = self._kept.resyncs and not (at_once and passed)
            self.expect_kept(what, data, partial(self._again, what, data))

    def _reply_after(self, what: str, data: bytes, query: Request[Any]) -> Reply[Any] | None:
        """Send a query of another id at once; return its reply, None if anything else comes too.

        The other id shows that the reply is not to the malformed request.
        """
        requester, linger = self._device.requester, self._device.timing.linger
        response = requester.send_bytes(self._request, data, what, linger)
        if response.replies or response.unexpected:
            return None
        good = self._device.count(requester.send(requester.prepare(query)))
        return good.valid.message if good.only_valid and good.valid else None

    def _send_and_wait(self, case: TestCase, what: str, data: bytes) -> bool:
        """Send it without a query after it, then the good request; return whether both pass."""
        response = self._send_alone(what, data)
        silent = not response.replies and not response.unexpected
        self._probe.expect(case, silent, f"{what}: expected no reply; received {response.summary}")
        good = self._device.count(self._device.requester.send(self._good(data)))
        call = f"the good request {good.request.command.name} after {what}"
        expect_one_reply(self._probe, RECOVERS, good, call)
        return silent and good.only_valid

    def _good(self, data: bytes) -> EncodedRequest:
        """Return a good request that is too short to complete half a request before it."""
        frame = self._device.table.frame
        missing = frame.read_length(data) + frame.overhead - len(data)
        query = self._device.command("powered")
        if missing <= 0 or query is None or not query.reply:
            return self._request
        short = self._device.requester.prepare(query.request_type())
        return short if len(short.frame) < missing else self._request

    def _send_alone(self, what: str, data: bytes) -> Response:
        device, frame = self._device, self._device.table.frame
        half = frame.read_length(data) + frame.overhead > len(data)
        seconds = device.timing.idle if half else device.timing.silence
        return device.requester.send_bytes(self._request, data, what, seconds)

    def expect_kept(
        self,
        what: str,
        data: bytes,
        again: Callable[[], object],
        reply: Reply[Any] | None = None,
    ) -> None:
        """Compare one value of the state with what it was.

        ``again`` sends the malformed request again; ``reply`` is the reply to the query of the
        value, if it has been sent. After one lost value, later ones are not reported: they would
        only end the test case early.
        """
        sent = Malformed(f"{what}, {self._request.command.name}", data, again)
        changed = self._kept.check(sent, reply)
        if not self._lost:
            self._probe.expect(KEPT, not changed, changed)
        self._lost = self._lost or bool(changed)

    def expect_all_kept(self) -> None:
        """Compare all values of the state; then restore what was set for the comparison."""
        changes = list(self._kept.check_all())
        self._probe.expect(KEPT, not changes, "; ".join(changes[:MOST_CHANGES]))
        self._kept.close()
        self._probe.run.kept = None

    def _again(self, what: str, data: bytes) -> None:
        self._send_alone(what, data)
        self._device.requester.send(self._request)


def expect_one_reply(probe: Probe, case: TestCase, response: Response, what: str) -> None:
    """Expect one legal reply, and nothing else."""
    deadline = response.request.command.deadline_ms
    late = response.late and bool(response.replies)
    took = f" after {1000 * response.replies[0].seconds:.0f} ms" if late else ""
    reason = f"{what}: expected one legal reply within {deadline} ms; received "
    probe.expect(case, response.only_valid and not late, reason + response.summary + took)
