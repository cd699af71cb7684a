"""The pytest plugin. Every pytest run imports it, so it imports the rest only when needed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from cobotwire.simulator.testing.options import ArmOptions

MARK = "simulated_arm"
ABOUT = (
    f"{MARK}(edition='mycobot280', scenario=None, transport=None, speed=1.0, seed=None): which arm "
    "the fixtures simulated_arm and simulated_arm_url create; scenario is a YAML file, the name "
    "of one that comes with cobotwire, or an object with wrap(); transport is memory, pty or tcp"
)


def pytest_configure(config: pytest.Config) -> None:
    """Register the mark, also for --strict-markers."""
    config.addinivalue_line("markers", ABOUT)


@pytest.fixture
def simulated_arm(request: pytest.FixtureRequest) -> Iterator[Any]:
    """Yield a client, connected to a simulated arm that is powered off, with all joints at zero.

    By default the arm is in memory and in stepped time: a motion of ten seconds is over at once.
    """
    from cobotwire.simulator.testing.simulation import connected

    with connected(_options(request)) as arm:
        yield arm


@pytest.fixture
def simulated_arm_url(request: pytest.FixtureRequest) -> Iterator[str]:
    """Yield the port of a simulated arm, for any client library; in real time, by default a pty."""
    from cobotwire.simulator.testing.simulation import served

    with served(_options(request)) as url:
        yield url


def _options(request: pytest.FixtureRequest) -> ArmOptions:
    """Combine the marks: those of a test override those of its class and module."""
    from cobotwire.simulator.testing.options import combined

    marks = reversed(list(request.node.iter_markers(MARK)))
    return combined([(mark.args, mark.kwargs) for mark in marks], request.path.parent)
