"""Every caller gets a LinkError at once if a port is missing, in use, or lost."""

from __future__ import annotations

import threading
import time
from typing import Any

import pytest

from both_ways import Opener
from cobotwire import LinkError, MyCobot, RetryPolicy
from cobotwire.editions.mycobot import Angles
from scripted_peer import ScriptedPeer

ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
READ = Angles(1.4, 0.61, -0.26, -1.93, 1.75, -1.75)
REQUEST = bytes.fromhex("FE FE 02 20 FA")
ONCE = RetryPolicy(attempts=1)


def test_missing_port_is_a_link_error(open_arm: Opener) -> None:
    with pytest.raises(
        LinkError, match="/dev/nosuchport: cannot be opened: No such file"
    ) as caught:
        open_arm("/dev/nosuchport")
    assert isinstance(caught.value, OSError)


def test_closed_client_is_a_link_error(open_arm: Opener) -> None:
    with ScriptedPeer() as peer, open_arm(peer.url) as arm:
        arm.close()
        arm.close()
        with pytest.raises(LinkError, match="closed"):
            arm.power_on()
        with pytest.raises(LinkError, match="closed"):
            arm.get_angles()
        assert peer.received == b""


def test_unplugged_port_ends_the_wait_with_a_link_error(open_arm: Opener, peer_on: Any) -> None:
    with peer_on([ANGLES[:5], 0.1, None]) as peer, open_arm(peer.url, timeout=5) as arm:
        started = time.monotonic()
        with pytest.raises(LinkError):
            arm.get_angles()
        assert time.monotonic() - started < 1
        with pytest.raises(LinkError):
            arm.get_angles()


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


def test_port_that_another_program_has_open_is_a_link_error(open_arm: Opener) -> None:
    with ScriptedPeer() as peer, MyCobot(peer.url):
        with pytest.raises(LinkError, match="another program has it open"):
            open_arm(peer.url)
