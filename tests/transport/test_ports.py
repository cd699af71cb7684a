"""List the ports, and mark those that may lead to an arm."""

from __future__ import annotations

import glob
import os
from pathlib import Path

import pytest
from serial.tools import list_ports

from cobotwire.transport.serial import ports as listing
from cobotwire.transport.serial.chips import CHIPS, Chip
from cobotwire.transport.serial.ports import Port, leads_to_device, ports, recognise


@pytest.mark.parametrize("chip", CHIPS)
def test_known_usb_chip_is_likely_under_any_port_name(chip: Chip) -> None:
    for device in ("/dev/ttyUSB0", "/dev/cu.usbserial-1", "COM3"):
        assert recognise(device, chip.usb) == (True, chip.name)


@pytest.mark.parametrize("device", ["/dev/ttyAMA0", "/dev/ttyTHS1"])
def test_built_in_port_of_a_board_in_the_base_is_likely(device: str) -> None:
    likely, why = recognise(device, "")
    assert likely
    assert "built-in port" in why


@pytest.mark.parametrize(
    ("device", "usb", "reason"),
    [
        ("/dev/ttyUSB0", "2341:0043", "a USB device that no such arm has"),
        ("/dev/ttyAMA0", "2341:0043", "a USB device that no such arm has"),
        ("/dev/ttyS0", "", "neither a USB device nor a built-in port"),
        ("COM1", "", "neither a USB device nor a built-in port"),
        ("", "", "neither a USB device nor a built-in port"),
    ],
)
def test_other_port_is_unlikely_and_has_a_reason(device: str, usb: str, reason: str) -> None:
    likely, why = recognise(device, usb)
    assert not likely
    assert why.startswith(reason)


class Info:
    """A port as pyserial reports it; the tests' machines have no such ports."""

    def __init__(self, device: str, vid: int | None = None, pid: int | None = None) -> None:
        self.device, self.vid, self.pid = device, vid, pid
        self.description = "n/a"
        self.serial_number = "0123" if vid else None


def test_likely_ports_are_listed_first_even_if_pyserial_does_not_list_them(
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
    assert not found[2].accessible, "it does not exist"


def test_ports_of_this_machine_include_those_of_pyserial() -> None:
    assert {info.device for info in list_ports.comports()} <= {port.device for port in ports()}


def test_only_usb_and_built_in_ports_show_that_a_device_is_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    device, link = tmp_path / "ttyX0", tmp_path / "arm"
    link.symlink_to(device)
    for likely, usb, real in ((False, "", False), (False, "1234:5678", True), (True, "", True)):
        port = Port(str(device), likely, "", True, usb=usb)
        monkeypatch.setattr(listing, "ports", lambda port=port: [port])
        assert leads_to_device(str(device)) == leads_to_device(str(link)) == real
        assert not leads_to_device("socket://127.0.0.1:9000")
