"""Fixtures that every test may use, and the profiles of Hypothesis."""

from __future__ import annotations

import gc
import os
import signal
from collections.abc import Iterator

import pytest
from hypothesis import HealthCheck, settings

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot import TABLE, MyCobot
from cobotwire.simulator import PtyServer, SimulatedArm

# Hooks of pytest, for all tests.
from pty_users import pytest_ignore_collect, pytest_itemcollected
from stalled_reruns import pytest_runtest_protocol, pytest_terminal_summary

__all__ = [
    "pytest_ignore_collect",
    "pytest_itemcollected",
    "pytest_runtest_protocol",
    "pytest_terminal_summary",
]

settings.register_profile(
    "quick",
    max_examples=100,
    deadline=None,  # examples are sometimes slow on two busy cores
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile(
    "deep",
    settings.get_profile("quick"),
    # `make fuzz` sets as many as its time allows (deep.py).
    max_examples=int(os.environ.get("HYPOTHESIS_EXAMPLES", "20000")),
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "quick"))


def pytest_configure() -> None:
    """Restore Ctrl-C in tests and their subprocesses; a background shell may have disabled it."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_finish() -> None:
    """Keep the garbage collector from what lives to the end, such as tests and loaded editions."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 20)


def pytest_unconfigure() -> None:
    """Let objects be freed when the interpreter ends; some libraries report those that are not."""
    gc.unfreeze()


@pytest.fixture(params=["reference", "native"])
def codec(request: pytest.FixtureRequest) -> Codec:
    """Run the test on both codecs. A missing binary is a failure, not a skip."""
    return codecs.load(TABLE, request.param)


@pytest.fixture
def simulated() -> SimulatedArm:
    """Return a simulated arm that is switched off."""
    return SimulatedArm(TABLE)


@pytest.fixture
def server(simulated: SimulatedArm) -> Iterator[PtyServer]:
    """Serve the simulated arm on a real pseudo-terminal."""
    with PtyServer(simulated) as serving:
        yield serving


@pytest.fixture
def arm(server: PtyServer) -> Iterator[MyCobot]:
    """Connect the generated client to the simulated arm through pyserial."""
    with MyCobot(server.url) as client:
        yield client
