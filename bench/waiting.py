"""Measure how soon a client notices that a motion has ended, and how many queries that takes.

A simulated arm on a pty sends its replies at 115,200 baud, a few milliseconds after each request.
The delay starts when the arm is so near its target that it reports that the target is reached. For
an arm that reports the end of its motions, the delay starts when the arm is at rest.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from copy import deepcopy
from importlib import import_module
from random import Random
from statistics import median, quantiles
from typing import Any

from cobotwire import codec as codecs
from cobotwire.protocol.roles import ANGLES, kinds_of
from cobotwire.session import Traffic
from cobotwire.session.motion import TOLERANCES
from cobotwire.simulator import PtyServer, SimulatedArm
from cobotwire.simulator.faults import Late, Scenario, Slow
from responder import within

MOTIONS, BAUD, LIMIT = 30, 115_200, 60
FAULTS = (Late(seconds=0.004, jitter_seconds=0.006), Slow(bits_per_second=BAUD))
LINE = Scenario(name="line", faults=FAULTS)


def main() -> None:
    """Measure each edition; print delays and queries."""
    for name in ("mycobot280", "myarm_m750", "mercury_a1"):
        package: Any = import_module(f"cobotwire.editions.{name}")
        arm = SimulatedArm(package.TABLE, powered=True)
        traffic: list[Traffic] = []
        with (
            PtyServer(LINE.wrap(arm, codecs.load(package.TABLE))) as server,
            package.CLIENT(server.url, trace=traffic.append) as client,
        ):
            print(f"{name:12}{_measured(arm, client, traffic)}")


def _measured(arm: SimulatedArm, client: Any, traffic: list[Traffic]) -> str:
    draws = Random(1)  # noqa: S311  (repeatable, no secret)
    delays, queries, seconds, busiest = [], 0, 0.0, 0
    home = [sum(ends) / 2 for ends in zip(arm.state.minimum, arm.state.maximum)]
    for _ in range(MOTIONS):
        target = [round(at + draws.uniform(-20, 20), 1) for at in home]
        client.move_angles(target, draws.randint(30, 100), wait=False)
        client.listen(0.02)
        ended = _end(arm, target)
        traffic.clear()
        client.wait_until_reached(target, kinds_of(client.table)[ANGLES])
        delays.append(time.monotonic() - ended)
        sent = [one.time for one in traffic if one.direction == "sent"]
        queries, seconds = queries + len(sent), seconds + time.monotonic() - sent[0]
        busiest = max(busiest, *(sum(at <= each < at + 1 for each in sent) for at in sent))
    middle, last = median(delays) * 1e3, quantiles(delays, n=100)[-1] * 1e3
    verdict = f"{within(middle <= LIMIT)} {LIMIT} ms   99 % {last:5.1f} ms"
    return (
        f"median {middle:5.1f} ms  {verdict}  {queries / seconds:4.1f} queries/s, {busiest} at most"
    )


def _end(arm: SimulatedArm, target: Sequence[float]) -> float:
    axes, now = deepcopy(arm.state.angles), time.monotonic()
    reports = arm.table.find_role("motion ended")
    near = arm.state.near[0] if arm.table.find_role("reached") else TOLERANCES["degree"]
    while axes.moving(now) and (
        reports or any(abs(a - b) > near for a, b in zip(axes.position(now), target))
    ):
        now += 0.001
    return now


if __name__ == "__main__":
    main()
