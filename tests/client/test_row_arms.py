"""Arms of the maker with other numbers of joints move and are waited for, over a pty."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from both_ways import InLoop
from cobotwire import ReplyTimeout, UsageError
from cobotwire.editions import load
from cobotwire.simulator import PtyServer, SimulatedArm

EDITIONS = {"mypalletizer260": 4, "myarm300": 7}


@pytest.fixture(params=EDITIONS)
def edition(request: pytest.FixtureRequest) -> Any:
    return load(request.param)


@pytest.fixture
def url(edition: Any) -> Iterator[str]:
    with PtyServer(SimulatedArm(edition.TABLE, powered=True)) as server:
        yield server.url


def test_joints_move_and_are_waited_for(edition: Any, url: str) -> None:
    joints = EDITIONS[edition.TABLE.edition]
    first, second = [1.0] * joints, [2.0] * joints
    with edition.CLIENT(url, timeout=0.4) as arm:
        arm.move_angles(first, 100)
        assert arm.get_angles() == pytest.approx(first, abs=0.5)
        with pytest.raises(UsageError):
            arm.move_angles([0.0] * 6, 100)
        with pytest.raises(ReplyTimeout):  # no source gives the geometry
            arm.get_coords()
    with InLoop(edition.ASYNC_CLIENT, url) as arm:
        arm.send_angles(second, 100)
        arm.wait_until_reached(second)
        assert arm.is_in_position(second)
