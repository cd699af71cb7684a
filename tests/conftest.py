"""Fixtures that every test may use, and the profiles of Hypothesis."""

from __future__ import annotations

import gc
import os
import signal
import tempfile
from collections.abc import Iterator
from contextlib import suppress

import pytest
from hypothesis import HealthCheck, settings

from cobotwire import codec as codecs
from cobotwire.client import persisted_state, port_notes
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot import TABLE, MyCobot
from cobotwire.simulator import PtyServer, SimulatedArm
from probe import Probe, needed

# Hooks of pytest, for all tests.
from pty_users import pytest_ignore_collect, pytest_itemcollected
from session.twins import Recorder
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
    # `make fuzz` sets the number that its time allows (deep.py).
    max_examples=int(os.environ.get("HYPOTHESIS_EXAMPLES", "20000")),
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "quick"))


TEMPORARY = pytest.StashKey[tempfile.TemporaryDirectory[str]]()


def pytest_configure(config: pytest.Config) -> None:
    """Enable Ctrl-C, set a temporary folder, and collect no garbage until the tests start.

    A background shell may have disabled Ctrl-C. Notes on ports are temporary files: with its own
    folder, this process does not read the notes of tests in other processes. Nearly all objects
    that exist before the tests start are kept, so collecting garbage would be wasted time.
    """
    gc.disable()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    config.stash[TEMPORARY] = tempfile.TemporaryDirectory(prefix="cw-")
    os.environ["TMPDIR"] = config.stash[TEMPORARY].name
    # Tests start pytest in other processes, which need no Hypothesis. Importing it takes longer
    # than the rest of their start.
    os.environ["PYTEST_ADDOPTS"] = "-p no:hypothesispytest"


def pytest_collection_finish() -> None:
    """Let the garbage collector ignore objects that live to the end: tests, loaded editions."""
    gc.collect()
    gc.freeze()
    gc.enable()
    gc.set_threshold(20_000, 20, 20)


def pytest_unconfigure(config: pytest.Config) -> None:
    """Let objects be freed at exit; some libraries report objects that remain."""
    gc.unfreeze()
    config.stash[TEMPORARY].cleanup()


@pytest.fixture(autouse=True)
def _ports_without_notes() -> None:
    """Remove the notes on ports: the system may give the same TCP port to a server of another test.

    Because of a note, a client would complete a request that this server never received.
    """
    persisted_state._here.clear()
    with suppress(FileNotFoundError):
        for note in os.scandir(port_notes._folder(create=False)):
            os.unlink(note.path)


@pytest.fixture(params=["reference", "native"])
def codec(request: pytest.FixtureRequest) -> Codec:
    """Run the test on both codecs. A missing binary is a failure, not a skip."""
    return codecs.load(TABLE, request.param)


@pytest.fixture(scope="module")
def probe() -> Iterator[Probe]:
    """Yield a probe, which the tests of a module share."""
    made = Probe()
    yield made
    made.close()


@pytest.fixture
def repeated_in_rust(request: pytest.FixtureRequest) -> Iterator[None]:
    """Repeat the exchanges of a test in the Rust core, and compare the results."""
    if needed.args[0]:
        yield
        return
    probe: Probe = request.getfixturevalue("probe")
    with Recorder() as recorder:
        yield
    recorder.check(probe.ask)


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
