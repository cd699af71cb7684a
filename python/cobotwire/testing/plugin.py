"""The pytest plugin. It is imported by every pytest run, so it imports only what it needs then."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from cobotwire.testing.wanted import Wanted

MARK = "simulated_arm"
ABOUT = (
    f"{MARK}(edition='mycobot', scenario=None, link=None, speed=1.0, seed=None): how the fixtures "
    "simulated_arm and simulated_arm_url make their arm; scenario is a YAML file, the name of one "
    "that comes with cobotwire, or an object with wrap(); link is memory, pty or tcp"
)


def pytest_configure(config: pytest.Config) -> None:
    """Make the mark known, also to --strict-markers."""
    config.addinivalue_line("markers", ABOUT)


@pytest.fixture
def simulated_arm(request: pytest.FixtureRequest) -> Iterator[Any]:
    """A client that is connected to a simulated arm, which is switched off and stands at zero.

    By default in memory and in stepped time: a motion of ten seconds is over at once.
    """
    from cobotwire.testing.simulation import connected

    with connected(_wanted(request)) as arm:
        yield arm


@pytest.fixture
def simulated_arm_url(request: pytest.FixtureRequest) -> Iterator[str]:
    """The port of a simulated arm, for any client library; in real time, by default on a pty."""
    from cobotwire.testing.simulation import served

    with served(_wanted(request)) as url:
        yield url


def _wanted(request: pytest.FixtureRequest) -> Wanted:
    """What the marks say, the nearest last: a test's own goes before its class's and module's."""
    from cobotwire.testing.wanted import wanted

    marks = reversed(list(request.node.iter_markers(MARK)))
    return wanted([(mark.args, mark.kwargs) for mark in marks], request.path.parent)
