"""Every caller gets a LinkError of its own at once if a port is closed or lost."""

from __future__ import annotations

import threading
import time
from typing import Any

import pytest

from both_ways import Opener
from cobotwire import LinkError
from scripted_peer import ScriptedPeer


def test_closed_client_is_a_link_error(open_arm: Opener) -> None:
    with ScriptedPeer() as peer, open_arm(peer.url) as arm:
        arm.close()
        arm.close()
        with pytest.raises(LinkError, match="closed"):
            arm.power_on()
        with pytest.raises(LinkError, match="closed"):
            arm.get_angles()
        assert peer.received == b""


def test_unplugged_port_ends_every_wait_with_its_own_link_error(
    open_arm: Opener, peer_on: Any
) -> None:
    errors: list[BaseException] = []

    def query(joint: int) -> None:
        try:
            arm.get_encoder(joint)
        except LinkError as error:
            errors.append(error)

    with peer_on([0.2, None]) as peer, open_arm(peer.url, timeout=5) as arm:
        started = time.monotonic()
        threads = [threading.Thread(target=query, args=(joint,)) for joint in range(1, 5)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert time.monotonic() - started < 2
    assert len(errors) == 4
    assert len({id(error) for error in errors}) == 4
