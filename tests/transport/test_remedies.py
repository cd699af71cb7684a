"""Say what to do so that a port can be opened, on every system."""

from __future__ import annotations

import errno
import os
import pwd

import pytest
from serial import SerialException

from cobotwire.protocol.errors import LinkError
from cobotwire.transport.serial import linux, ports
from cobotwire.transport.serial.chips import CHIPS
from cobotwire.transport.serial.opening import opening
from cobotwire.transport.serial.remedies import Computer, explain, remedies

USB = "/dev/ttyUSB0"
ALICE = Computer("linux", [USB], "alice", "dialout")
WINDOWS = Computer("win32", ["COM3", "COM7"])
TTY = "/dev/tty.usbserial-1"


@pytest.mark.parametrize(
    ("computer", "device", "number", "text"),
    [
        (ALICE, USB, errno.EACCES, "why; you (alice) are not in the group dialout"),
        (ALICE._replace(member=True), USB, errno.EACCES, "log out and in again"),
        (ALICE._replace(group=""), USB, errno.EACCES, "no group opens it"),
        (ALICE._replace(in_login=True), USB, errno.EPERM, "why, although you (alice) are in"),
        (ALICE, "/dev/ttyUSB3", errno.ENOENT, "why; did you mean /dev/ttyUSB0?"),
        (ALICE, "ttyACM0", errno.ENOENT, "why; did you mean /dev/ttyACM0?"),
        (ALICE, "10.0.0.2:9000", errno.ENOENT, "why; did you mean socket://10.0.0.2:9000?"),
        (ALICE, "/dev/null", errno.ENOTTY, "it is not a serial port;"),
        (ALICE, "/dev/ttyACM0", errno.ENOENT, "why; this computer has /dev/ttyUSB0;"),
        (ALICE, USB, errno.EBUSY, "BY has it open; end that first"),
        (ALICE, USB, errno.EIO, "why"),
        (WINDOWS, "COM3", errno.EACCES, "BY has it open"),
        (WINDOWS, "COM4", errno.ENOENT, "why; did you mean COM3? this computer has COM3, COM7;"),
        (Computer("darwin", [TTY]), TTY, errno.ENXIO, "why; open /dev/cu.usbserial-1 instead"),
        (Computer("darwin", ["a\x1b[2J\nb"]), "/dev/cu.x", errno.ENOENT, r"has a\x1b[2J\nb;"),
        (ALICE._replace(user="a\x1b"), USB, errno.EACCES, r"(a\x1b) are not in the group"),
    ],
)
def test_opening_error_gives_advice_for_the_operating_system(
    computer: Computer, device: str, number: int, text: str
) -> None:
    assert text in explain(computer, device, number, "why", "BY")


def test_linux_advice_covers_every_chip_and_omits_the_group_once_joined() -> None:
    group, rule, _ = remedies(ALICE)
    assert (group.state, group.commands) == ("needed", ("sudo usermod -aG dialout alice",))
    for chip, line in zip(CHIPS, rule.commands[1:]):
        assert all(f'=="{number}"' in line for number in chip.usb.lower().split(":"))
    assert remedies(ALICE._replace(member=True))[0].commands == ()
    assert remedies(ALICE._replace(member=True, in_login=True))[0].state == "done"


def test_macos_and_windows_advice_names_the_driver_of_every_chip() -> None:
    for system in ("darwin", "win32"):
        name, *drivers = remedies(Computer(system))
        assert ("/dev/cu.NAME" in name.text) == (system == "darwin")
        for chip, driver in zip(CHIPS, drivers):
            assert chip.name in driver.text
            assert chip.driver in driver.text
            assert (chip.shown in driver.text) == (system == "win32" or not chip.shown)


@pytest.mark.parametrize(
    ("error", "text"),
    [
        # Windows writes messages in the user's language, so only the error number identifies them.
        (FileNotFoundError(2, "Datei nicht gefunden", None), "this computer has no serial port"),
        (PermissionError(13, "Zugriff verweigert", None), "another program has it open, such as"),
        (OSError(22, "Falscher Parameter", None), "Falscher Parameter"),
    ],
)
def test_windows_error_number_is_read_from_the_message_of_pyserial(
    monkeypatch: pytest.MonkeyPatch, error: OSError, text: str
) -> None:
    # Pretend that this machine runs Windows.
    monkeypatch.setattr(ports, "this_computer", lambda device: Computer("win32"))
    with pytest.raises(LinkError, match=text), opening("COM3", "COM3"):
        raise SerialException(f"could not open port 'COM3': {error!r}")


def test_user_and_group_are_those_of_the_system() -> None:
    found = linux.this_computer([])
    assert found.user == pwd.getpwuid(os.getuid()).pw_name
    assert found.in_login or found.group in linux.GROUPS
    assert ports.programs_using("/dev/no-such-port") == ""
