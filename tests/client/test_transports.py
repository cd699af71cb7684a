"""Clients without the native codec, on a terminal that fails, and called by a traffic listener."""

from __future__ import annotations

import termios

import pytest

from cobotwire import LinkError, MyCobot, UsageError
from cobotwire import codec as codecs
from cobotwire.client import Traffic
from cobotwire.editions.mycobot import TABLE
from cobotwire.simulator import PtyServer, SimulatedArm
from scripted_peer import ScriptedPeer


def test_native_codec_without_its_binary_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(codecs, "native_available", lambda: False)
    with pytest.raises(UsageError, match="the native codec is not installed; use 'reference'"):
        MyCobot("loop://", codec="native")


def test_terminal_error_is_a_link_error(monkeypatch: pytest.MonkeyPatch) -> None:
    # pyserial itself writes to the port of a spy:// URL.
    with ScriptedPeer() as peer, MyCobot(f"spy://{peer.url}") as arm:

        def fail(*arguments: object) -> int:
            raise termios.error(5, "Input/output error")

        # No real port can be made to fail in this way.
        monkeypatch.setattr(arm._connection._transport._port, "write", fail)  # type: ignore[attr-defined]
        with pytest.raises(LinkError, match=r"cannot be written: .*Input/output error"):
            arm.power_on()


def test_traffic_listener_may_call_the_arm() -> None:
    seen: list[bool] = []

    def watch(traffic: Traffic) -> None:
        if traffic.direction == "received" and not seen:
            seen.append(True)
            seen.append(arm.is_power_on())

    with PtyServer(SimulatedArm(TABLE)) as server, MyCobot(server.url, trace=watch) as arm:
        arm.get_angles()
    assert seen == [True, False]
