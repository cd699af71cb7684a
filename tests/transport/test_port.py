"""Check what only serial ports have: locks, control lines, terminal modes."""

from __future__ import annotations

import fcntl
import grp
import os
import resource
import struct
import subprocess
import sys
import termios
from pathlib import Path
from typing import Any

import pytest
from serial.tools import list_ports

from cobotwire.protocol.errors import LinkError
from cobotwire.transport import open_transport
from cobotwire.transport.serial.opening import request_low_latency
from cobotwire.transport.serial.port import keep_others_out
from cobotwire.transport.waiting import SELECTABLE, Waiter
from transport.ends import FAST, Line, PtyEnd

OPEN = """
import sys
from cobotwire import LinkError
from cobotwire.transport import open_transport
try:
    open_transport(sys.argv[1], 115200)
except LinkError as error:
    print(error)
else:
    print("opened")
"""

AS_NOBODY = """
import os
from cobotwire.protocol.error_texts import stored_texts
from cobotwire.transport.serial import linux, port, ports
stored_texts("error_texts.json")
os.setgroups([])
os.setgid(65534)
os.setuid(65534)
"""

# Changes to the user `nobody` only after Python is loaded, since its files may be root's.
OPEN_WITHOUT_LOCK = """
import os, sys
os.setuid(65534)
try:
    os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
except OSError as error:
    print(error.strerror)
else:
    print("opened")
"""


def in_another_process(script: str, *arguments: str) -> str:
    result = subprocess.run(
        [sys.executable, "-c", script, *arguments], capture_output=True, text=True, check=True
    )
    return result.stdout.strip()


def test_second_process_on_a_port_is_a_link_error() -> None:
    with Line("serial") as line:
        message = in_another_process(OPEN, line.end.url)
        this = Path("/proc/self/comm").read_text().strip()
        assert f"{this} (process {os.getpid()}) has it open; end that first" in message
        line.transport.close()
    end = PtyEnd()
    assert in_another_process(OPEN, end.url) == "opened"
    end.unplug()


def test_second_transport_of_this_process_on_a_port_is_a_link_error() -> None:
    with Line("serial") as line:
        with pytest.raises(LinkError, match="this program itself has it open"):
            open_transport(line.end.url, 115200)
        with pytest.raises(LinkError, match="another program has it open"):
            open_transport(f"spy://{line.end.url}", 115200)


@pytest.mark.skipif(os.getuid() != 0, reason="only root can become another user")
def test_missing_permission_names_the_group_that_the_user_is_not_in() -> None:
    end, group = PtyEnd(), grp.getgrnam("dialout")
    os.chown(end.url, 0, group.gr_gid)
    os.chmod(end.url, 0o660)
    try:
        message = in_another_process(AS_NOBODY + OPEN, end.url)
    finally:
        end.unplug()
    assert "Permission denied; you (nobody) are not in the group dialout" in message


@pytest.mark.skipif(os.getuid() != 0, reason="only root can become another user")
def test_program_that_ignores_locks_cannot_open_the_port() -> None:
    end = PtyEnd()
    os.chmod(end.url, 0o666)
    try:
        assert in_another_process(OPEN_WITHOUT_LOCK, end.url) == "opened"
        keep_others_out(end._slave)
        assert in_another_process(OPEN_WITHOUT_LOCK, end.url) == "Device or resource busy"
    finally:
        end.unplug()


def test_dtr_and_rts_are_lowered_together(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[tuple[int, int]] = []
    real = fcntl.ioctl

    def watch(descriptor: Any, request: int, *rest: Any) -> Any:
        if request in (termios.TIOCMBIC, termios.TIOCMBIS):
            calls.append((request, struct.unpack("I", rest[0])[0]))
        return real(descriptor, request, *rest)

    # A pty has no DTR and RTS, so only the patched call shows how they are set.
    monkeypatch.setattr(fcntl, "ioctl", watch)
    with Line("serial"):
        assert calls[0] == (termios.TIOCMBIC, termios.TIOCM_DTR | termios.TIOCM_RTS)
        assert all(request == termios.TIOCMBIC for request, _ in calls)


def test_terminal_is_raw_and_data_cannot_stop_it() -> None:
    with Line("serial") as line:
        descriptor = line.transport.fileno()
        assert descriptor is not None
        incoming, outgoing, control, local, *_ = termios.tcgetattr(descriptor)
        assert incoming & (termios.IXON | termios.IXOFF | termios.IXANY | termios.ICRNL) == 0
        assert outgoing & termios.OPOST == 0
        assert local & (termios.ECHO | termios.ICANON | termios.ISIG) == 0
        assert control & getattr(termios, "CRTSCTS", 0) == 0


def test_port_without_low_latency_mode_is_opened() -> None:
    with Line("serial") as line:
        assert line.transport.low_latency is False


def test_low_latency_is_requested() -> None:
    modes = []

    class Port:
        def set_low_latency_mode(self, wanted: bool) -> None:
            modes.append(wanted)

    # No port of the test machines has that mode.
    assert request_low_latency(Port()) is True
    assert modes == [True]


def test_descriptor_too_high_for_select_can_be_waited_for() -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = SELECTABLE + 100
    if soft <= wanted:
        if hard <= wanted:
            pytest.skip(f"this system allows {hard} open files, the test needs {wanted}")
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted + 1, hard))
    with Line("serial") as line:
        descriptor = line.transport.fileno()
        assert descriptor is not None
        high = fcntl.fcntl(descriptor, fcntl.F_DUPFD, wanted)
        waiter = Waiter()
        try:
            assert waiter.wait(high, 0, writing=True)
            assert not waiter.wait(high, 0.01)
            line.end.send(b"x")
            assert waiter.wait(high, 5.0)
        finally:
            os.close(high)
            waiter.close()
    resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def test_port_with_an_unusual_baud_rate_carries_bytes() -> None:
    with Line("serial", baudrate=FAST + 1) as line:
        line.transport.write(b"x")
        assert line.end.receive(1) == b"x"


def test_hwgrep_url_finds_the_port(monkeypatch: pytest.MonkeyPatch) -> None:
    ends = [PtyEnd(), PtyEnd()]
    plugged = ends[:1]
    # This machine has no such port, so pyserial is made to find a pty, and later another one.
    monkeypatch.setattr(list_ports, "grep", lambda text: [(end.url, "", "") for end in plugged])
    transport = open_transport("hwgrep://1A86:55D4", FAST)
    assert transport.kind == "serial"
    transport.write(b"first")
    assert ends[0].receive(5) == b"first"
    plugged[:] = ends[1:]
    transport.reopen()
    transport.write(b"second")
    assert ends[1].receive(6) == b"second"
    transport.close()
    for end in ends:
        end.unplug()
