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
from probe import Probe

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
    # `make fuzz` sets the number that its time allows (deep.py).
    max_examples=int(os.environ.get("HYPOTHESIS_EXAMPLES", "20000")),
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "quick"))


TEMPORARY = pytest.StashKey[tempfile.TemporaryDirectory[str]]()


def pytest_configure(config: pytest.Config) -> None:
    """Restore Ctrl-C in tests and their subprocesses; give them temporary files of their own.

    Nearly all that is created until tests start is kept: collect no garbage until then.

    A background shell may have disabled Ctrl-C. The notes on ports are temporary files: a test in
    another process may have left one on a TCP port that this process uses next.
    """
    gc.disable()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    config.stash[TEMPORARY] = tempfile.TemporaryDirectory(prefix="cw-")
    os.environ["TMPDIR"] = config.stash[TEMPORARY].name


def pytest_collection_finish() -> None:
    """Keep the garbage collector from what lives to the end, such as tests and loaded editions."""
    gc.collect()
    gc.freeze()
    gc.enable()
    gc.set_threshold(20_000, 20, 20)


def pytest_unconfigure(config: pytest.Config) -> None:
    """Let objects be freed when the interpreter ends; some libraries report those that are not."""
    gc.unfreeze()
    config.stash[TEMPORARY].cleanup()


@pytest.fixture(autouse=True)
def _ports_without_notes() -> None:
    """Forget the notes on ports: the system gives a TCP port again to a server of another test.

    Such a note makes a client send what ends half a request, which that server never received.
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
