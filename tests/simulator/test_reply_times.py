"""Test that no reply waits for a search of joint angles, whatever the target.

Work is counted in calls of functions, which no other load of the machine changes.
"""

from __future__ import annotations

import cProfile
import random
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from typing import Any

import pytest

from cobotwire.editions import load, names
from cobotwire.kinematics import Geometry, coords_of, flange, geometry_of, nearest
from cobotwire.kinematics.closed_form import is_solved
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.limits import joint_limits
from cobotwire.protocol.table import Command, Table
from cobotwire.simulator import PtyServer, SimulatedArm
from simulator.bench import Bench

WITH_GEOMETRY = [name for name in names() if geometry_of(load(name).TABLE) is not None]
# Commands that calculate joint angles; no edition has all of them.
SOLVING = (
    *("send_coord", "send_coords", "jog_coord", "jog_rpy", "jog_increment_coord"),
    "solve_inv_kinematics",
)
# A call takes a fifth of a microsecond. The most that 7,400 such requests took were 58,352 calls.
MOST_CALLS = 75_000
ROUND = (0.0, 0.0, 0.0, 10.0, -20.0, 90.0, -90.0)


def _pose(chance: random.Random, limits: list[tuple[float, float]]) -> tuple[float, ...]:
    """Draw angles; often a straight elbow or wrist, where a pose has no or many solutions."""
    if chance.random() < 0.4:
        return tuple(chance.uniform(low, high) for low, high in limits)
    return tuple(min(max(chance.choice(ROUND), low), high) for low, high in limits)


def _target(chance: random.Random, table: Table) -> tuple[float, ...]:
    """Draw coordinates: reachable, at the edge of the reach, or nearly anywhere."""
    geometry = geometry_of(table)
    assert geometry is not None
    x, y, z, *turns = coords_of(geometry, _pose(chance, joint_limits(table)))
    share = chance.choice((1.0, 0.999, 1.002, chance.uniform(0.2, 1.3)))
    return tuple(round(value, 2) for value in (x * share, y * share, z * share, *turns))


def _requests(table: Table, count: int) -> Iterator[tuple[tuple[float, ...], Command, list[Any]]]:
    """Yield start poses, and requests for which an arm calculates joint angles."""
    chance = random.Random(320)
    commands = [command for command in table.commands if command.name in SOLVING]
    for _ in range(count):
        start, target = _pose(chance, joint_limits(table)), _target(chance, table)
        command, axis = chance.choice(commands), chance.randint(1, 6)
        values = {"coords": target, "axis": axis, "coord": target[axis - 1], "angles": start}
        values |= {"direction": chance.randint(0, 1), "increment": chance.uniform(-200, 200)}
        values |= {"speed": 50, "mode": 1}
        if command.name == "jog_rpy":
            values["axis"] = 1 + axis % 3
        yield start, command, [values[field.name] for field in command.request[-1].fields]


@pytest.mark.parametrize("edition", WITH_GEOMETRY)
def test_work_for_a_reply_is_bounded_for_every_target(edition: str) -> None:
    table, worst = load(edition).TABLE, (0, "nothing")
    bench, sent = Bench(table), 0
    for start, command, values in _requests(table, 40):
        bench.send("stop")
        bench.arm.state.angles.place(start, bench.clock())
        with cProfile.Profile() as profile, suppress(UsageError):
            bench.send(command.name, *values)
            sent += 1
        calls = sum(entry.callcount for entry in profile.getstats())
        worst = max(worst, (calls, f"{command.name}{values} from {start}"))
        bench.clock.sleep(100)
    assert sent > 20
    assert worst[0] < MOST_CALLS, worst


@pytest.mark.parametrize("edition", WITH_GEOMETRY)
def test_pose_of_any_angles_is_found_by_the_shipped_arms(edition: str) -> None:
    table = load(edition).TABLE
    geometry, limits, chance = geometry_of(table), joint_limits(table), random.Random(9)
    assert geometry is not None
    assert is_solved(geometry)
    for _ in range(100):
        angles, present = (_pose(chance, limits) for _ in range(2))
        target = flange(geometry, angles)
        found = nearest(geometry, target, present, limits)
        assert found is not None, (angles, present)
        assert max(flange(geometry, found).distance(target)) <= 2e-3


def test_search_that_is_too_long_ends_with_a_note() -> None:
    edition: Any = load("mycobot320")
    stated = geometry_of(edition.TABLE)
    assert stated is not None
    # With other angles between the axes there is no closed form.
    skew = Geometry(tuple(replace(link, alpha=link.alpha + 7) for link in stated.links))
    arm = SimulatedArm(edition.TABLE, powered=True, geometry=skew)
    with PtyServer(arm) as server, edition.CLIENT(server.url) as client:
        client.send_coords([300.0, 150.0, 400.0, -90.0, 30.0, 10.0], 50)
        client.get_angles()
    [note] = arm.notes
    assert note.text.startswith("rejected: no joint angles reach (300.00, 150.00, 400.00")
    assert note.text.endswith("; the search ended after 80 steps")
