"""Run plans: one after another in this process, or in several processes for a limited time."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from functools import partial
from multiprocessing import get_context
from random import Random
from typing import Any

from attack.arm import HostilePeer
from attack.calls import SHORT
from attack.ends import PtyEnd, TcpEnd
from attack.fresh import run_fresh
from attack.line import HostileLine
from attack.machine import MachineMeter
from attack.plans import Plan, plan
from attack.profiles import Profile
from attack.setting import Setting, table_of
from attack.tally import Tally
from attack.users import Shared, run_threads
from attack.validating import Scene, Validator
from cobotwire import codec as codecs
from machine_stalls import PtyMeter
from stalls import StallMeter


def attack(chosen: Plan, change: Callable[[Any], Any] | None = None) -> Tally:
    """Run a plan and validate it; ``change`` maps the client class to another."""
    codec = codecs.load(table_of(chosen), "reference")
    peer = HostilePeer(codec, chosen.faults, chosen.seed)
    end = TcpEnd(small=chosen.profile.stalls) if chosen.tcp else PtyEnd()
    line = HostileLine(peer, codec, end)
    with (
        StallMeter(listed=True) as meter,
        PtyMeter(0.02, listed=True) as ptys,
        MachineMeter() as machine,
        line,
    ):
        setting = Setting(chosen, line.url)
        setting.processes = machine.processes
        if change is not None:
            setting.client = change(setting.client)
        settle, failed = partial(_settle, line, setting), ""
        if chosen.profile.fresh and change is None and not chosen.apart:
            failed = run_fresh(setting, settle)
        else:
            run_threads(setting, partial(_happen, line, setting), settle)
    if failed:
        # The calls of the run are not known; at least one of them was lost.
        counts = Counter(calls=1, lost=1)
        return Tally(chosen.profile.name, counts, failures=[f"{chosen}\n{failed}"])
    stalls = [meter.late, ptys.late, line.stalls, setting.stops, *machine.stops.values()]
    return Validator(Scene(setting, line, peer, stalls)).validate()


def _settle(line: HostileLine, setting: Setting) -> None:
    """Wait until the written bytes have arrived; closing would lose them."""
    if not setting.plan.restores:
        line.settle(setting.record.bytes_taken)


def _happen(line: HostileLine, setting: Setting, shared: Shared) -> None:
    """Break, stall or close until the time of the run is over; then end the run."""
    profile, random = setting.plan.profile, Random(f"{setting.plan.seed} line")
    until = time.monotonic() + setting.plan.seconds
    while not setting.over and time.monotonic() < until:
        if profile.breaks:
            time.sleep(profile.breaks * random.uniform(0.5, 1.5))
            line.unplug(resets=random.random() < 0.3)
            time.sleep(random.uniform(0.005, 0.1))
            line.replug()
        elif profile.closes:
            time.sleep(profile.closes * random.uniform(0.5, 1.5))
            shared.close()
        elif profile.stalls:
            time.sleep(random.uniform(0.05, 0.2))
            _stall(line, setting, random)
        else:
            time.sleep(0.02)
    setting.over = True


def _stall(line: HostileLine, setting: Setting, random: Random) -> None:
    """Stop reading, mostly until writes fail; then read again while short requests are sent."""
    line.stalled = True
    with setting.record.filling:
        line.fill(random.randint(10, 200))
    setting.flood, setting.flooding = "", True
    time.sleep(random.uniform(0.1, 1.0) if random.random() < 0.2 else random.uniform(1.05, 1.3))
    # These bytes may complete the request that was cut.
    setting.flood = random.choice(SHORT)
    time.sleep(0.02)
    line.stalled = False
    time.sleep(0.05)
    setting.flooding = False


def campaign(
    profiles: Sequence[Profile], seed: int, seconds: float, processes: int
) -> Iterator[Tally]:
    """Yield the tallies of plans until the seconds are over.

    Profiles take turns by their weights, so that each gets its share of the time.
    """
    until, plans = time.monotonic() + seconds, _plans(profiles, seed)
    running: set[Future[Tally]] = set()
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        while running or time.monotonic() < until:
            while len(running) < processes and time.monotonic() < until:
                running.add(pool.submit(attack, next(plans)))
            done, running = wait(running, return_when=FIRST_COMPLETED)
            yield from (future.result() for future in done)


def _plans(profiles: Sequence[Profile], seed: int) -> Iterator[Plan]:
    """Yield plans: the profile that had the least time for its weight is next."""
    had = dict.fromkeys(profiles, 0.0)
    while True:
        profile = min(had, key=lambda profile: had[profile] / profile.weight)
        chosen = plan(profile, seed)
        had[profile] += chosen.seconds
        seed += 1
        yield chosen
