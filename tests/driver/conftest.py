"""Both clients and both kinds of line, for the tests that hold on all of them."""

from __future__ import annotations

from typing import Any

import pytest

from both_ways import Opener, openers
from cobotwire.editions.mycobot import AsyncMyCobot, MyCobot
from scripted_peer import PEERS

OPENERS = openers(MyCobot, AsyncMyCobot)


@pytest.fixture(params=list(OPENERS))
def open_arm(request: pytest.FixtureRequest) -> Opener:
    """Opens a client of the document's edition; the asyncio one is used just like the other."""
    return OPENERS[request.param]


@pytest.fixture(params=list(PEERS))
def peer_on(request: pytest.FixtureRequest) -> Any:
    """Makes a scripted peer on a pseudo-terminal, or over TCP."""
    return PEERS[request.param]
