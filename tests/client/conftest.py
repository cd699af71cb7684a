"""Fixtures for tests that run with both clients and both kinds of transport."""

from __future__ import annotations

from typing import Any

import pytest

from both_ways import Opener, openers
from cobotwire.editions.mycobot import AsyncMyCobot, MyCobot
from scripted_peer import PEERS

OPENERS = openers(MyCobot, AsyncMyCobot)


@pytest.fixture(params=list(OPENERS))
def open_arm(request: pytest.FixtureRequest) -> Opener:
    """Return a function that opens a client of the document's edition; each test runs with both."""
    return OPENERS[request.param]


@pytest.fixture(params=list(PEERS))
def peer_on(request: pytest.FixtureRequest) -> Any:
    """Return a function that makes a scripted peer on a pseudo-terminal, or over TCP."""
    return PEERS[request.param]
