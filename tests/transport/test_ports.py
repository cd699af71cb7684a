"""Which ports there are, and behind which an arm may stand."""

from __future__ import annotations

import glob
import os

import pytest
from hypothesis import given
from hypothesis import strategies as st
from serial.tools import list_ports

from cobotwire.transport.serial.ports import BRIDGES, judge, ports


@pytest.mark.parametrize("ids", BRIDGES)
def test_a_known_bridge_is_likely_whatever_the_port_is_called(ids: tuple[int, int]) -> None:
    for device in ("/dev/ttyUSB0", "/dev/cu.usbserial-1", "COM3"):
        assert judge(device, *ids) == (True, BRIDGES[ids])


@pytest.mark.parametrize("device", ["/dev/ttyAMA0", "/dev/ttyTHS1"])
def test_the_built_in_port_of_a_board_in_the_arms_base_is_likely(device: str) -> None:
    likely, why = judge(device, None, None)
    assert likely
    assert "built-in port" in why


@given(st.text(), st.none() | st.integers(0, 0xFFFF), st.none() | st.integers(0, 0xFFFF))
def test_every_port_is_told_why(device: str, vendor: int | None, product: int | None) -> None:
    likely, why = judge(device, vendor, product)
    assert why
    assert likely or (vendor, product) not in BRIDGES


class Info:
    """What pyserial says of a port; no machine here has such ports."""

    def __init__(self, device: str, vid: int | None = None, pid: int | None = None) -> None:
        self.device, self.vid, self.pid = device, vid, pid
        self.description = "n/a"
        self.serial_number = "0123" if vid else None


def test_likely_ports_come_first_and_those_that_pyserial_does_not_list_are_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    infos = [Info("/dev/ttyS0"), Info("/dev/ttyACM9", 0x2341, 0x43), Info(os.devnull, 6790, 21972)]
    monkeypatch.setattr(list_ports, "comports", lambda: infos)
    monkeypatch.setattr(glob, "glob", lambda pattern: ["/dev/ttyTHS1"] if "THS" in pattern else [])
    found = ports()
    assert [port.device for port in found] == [
        os.devnull,
        "/dev/ttyTHS1",
        "/dev/ttyACM9",
        "/dev/ttyS0",
    ]
    assert [port.likely for port in found] == [True, True, False, False]
    assert found[0].usb == "1A86:55D4"
    assert found[0].serial_number == "0123"
    assert found[0].description == ""
    assert found[0].accessible
    assert not found[2].accessible, "there is none"


def test_the_ports_of_this_machine_are_those_of_pyserial() -> None:
    assert {info.device for info in list_ports.comports()} <= {port.device for port in ports()}
