"""Say what to do so that a port can be opened, on every system."""

from __future__ import annotations

import errno
import os
import pwd

import pytest
from hypothesis import given
from hypothesis import strategies as st
from serial import SerialException

from cobotwire.protocol.errors import LinkError
from cobotwire.transport.serial import linux, ports
from cobotwire.transport.serial.chips import CHIPS
from cobotwire.transport.serial.opening import opening
from cobotwire.transport.serial.remedies import Computer, explain, missing, remedies

ALICE = Computer("linux", ["/dev/ttyUSB0"], "alice", "dialout")
WINDOWS = Computer("win32", ["COM3", "COM7"])
TTY = "/dev/tty.usbserial-1"


@pytest.mark.parametrize(
    ("computer", "device", "number", "text"),
    [
        (ALICE, "/dev/ttyUSB0", errno.EACCES, "why; you (alice) are not in the group dialout"),
        (ALICE._replace(member=True), "/dev/ttyUSB0", errno.EACCES, "log out and in again"),
        (ALICE._replace(group=""), "/dev/ttyUSB0", errno.EACCES, "no group opens it"),
        (ALICE._replace(in_login=True), "/dev/x", errno.EPERM, "why, although you (alice) are in"),
        (ALICE, "/dev/ttyUSB3", errno.ENOENT, "why; did you mean /dev/ttyUSB0?"),
        (ALICE, "/dev/ttyACM0", errno.ENOENT, "why; this computer has /dev/ttyUSB0;"),
        (ALICE, "/dev/ttyUSB0", errno.EBUSY, "BY has it open; end that first"),
        (ALICE, "/dev/ttyUSB0", errno.EAGAIN, "BY has it open; end that first"),
        (ALICE, "/dev/ttyUSB0", errno.EIO, "why"),
        (WINDOWS, "COM3", errno.EACCES, "BY has it open"),
        (WINDOWS, "COM4", errno.ENOENT, "why; did you mean COM3? this computer has COM3, COM7;"),
        (Computer("win32"), "COM4", errno.ENOENT, "why; no serial port was found"),
        (Computer("darwin", [TTY]), TTY, errno.ENXIO, "why; open /dev/cu.usbserial-1 instead"),
        (Computer("darwin"), "/dev/cu.usbserial-1", errno.EACCES, "why"),
        (Computer("freebsd"), "/dev/cuaU0", None, "why"),
    ],
)
def test_error_says_what_to_do_on_the_system(
    computer: Computer, device: str, number: int | None, text: str
) -> None:
    assert text in explain(computer, device, number, "why", "BY")


def test_steps_of_linux_name_every_chip_and_the_group_unless_the_login_has_it() -> None:
    group, rule, _ = remedies(ALICE)
    assert (group.state, group.commands) == ("needed", ("sudo usermod -aG dialout alice",))
    assert all(f'{chip.vendor:04x}", ATTRS{{idProd' in "\n".join(rule.commands) for chip in CHIPS)
    assert remedies(ALICE._replace(member=True))[0].commands == ()
    assert remedies(ALICE._replace(member=True, in_login=True))[0].state == "done"
    busy = remedies(ALICE, [("/dev/ttyUSB0", "minicom (process 7)")])[0]
    assert busy.text == "/dev/ttyUSB0: minicom (process 7) has it open; end that first"


def test_other_systems_name_the_driver_of_every_chip() -> None:
    for system in ("darwin", "win32"):
        name, *drivers = remedies(Computer(system))
        assert ("/dev/cu.NAME" in name.text) == (system == "darwin")
        for chip, driver in zip(CHIPS, drivers):
            assert chip.name in driver.text
            assert chip.driver in driver.text
            assert (chip.shown in driver.text) == (system == "win32" or not chip.shown)


@given(st.text(), st.text(), st.text(), st.integers(0, 40))
def test_hostile_names_stay_one_printable_line(
    device: str, user: str, group: str, number: int
) -> None:
    for computer in (Computer("linux", [device], user, group), Computer(user, [device])):
        texts = [step.text for step in remedies(computer)] + [missing(computer, device)]
        assert all(text.isprintable() for text in texts)
        assert explain(computer, "/dev/x", number, "why")


@pytest.mark.parametrize(
    ("error", "text"),
    [
        # The texts of Windows are in the language of its user.
        (FileNotFoundError(2, "Datei nicht gefunden", None), "no serial port was found"),
        (PermissionError(13, "Zugriff verweigert", None), "another program has it open, such as"),
        (OSError(22, "Falscher Parameter", None), "Falscher Parameter"),
    ],
)
def test_number_of_an_error_of_windows_is_read_from_the_text_of_pyserial(
    monkeypatch: pytest.MonkeyPatch, error: OSError, text: str
) -> None:
    # Replaces the facts about this machine, which is not one with Windows.
    monkeypatch.setattr(ports, "this_computer", lambda device: Computer("win32"))
    with pytest.raises(LinkError, match=text), opening("COM3", "COM3"):
        raise SerialException(f"could not open port 'COM3': {error!r}")


def test_facts_of_this_computer_are_those_of_the_system() -> None:
    found = linux.this_computer([])
    assert found.user == pwd.getpwuid(os.getuid()).pw_name
    assert found.in_login or found.group in linux.GROUPS
    read, write = os.openpty()
    try:
        assert linux.programs_using(os.ttyname(write)) == "this program itself"
    finally:
        os.close(read)
        os.close(write)
    assert linux.programs_using("/dev/no-such-port") == ""
