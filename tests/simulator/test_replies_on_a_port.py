"""Test the bytes of replies that have several legal variants, as a client receives them."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest

from cobotwire import editions
from cobotwire.simulator import PtyServer, SimulatedArm, TcpServer
from cobotwire.simulator.arm import Note
from cobotwire.transport.interface import OpenedTransport
from cobotwire.transport.opening import open_transport

SECONDS = 5.0
POWER_ON, RELEASE_THE_THIRD = "FE FE 02 10 FA", "FE FE 03 56 03 FA"
ARE_ALL_ENABLED = "FE FE 02 51 FA"
# Write 10 into register 21, and 1000 into register 24; the last byte of the second is the mode.
WRITE_A_BYTE, WRITE_A_WORD = "FE FE 05 52 01 15 0A FA", "FE FE 07 52 01 18 03 E8 01 FA"


@pytest.fixture(params=["pty", "tcp"])
def port(request: pytest.FixtureRequest, edition: str) -> Iterator[OpenedTransport]:
    arm = SimulatedArm(editions.load(edition).TABLE, acks=False)
    with PtyServer(arm) if request.param == "pty" else TcpServer(arm.connect) as server:
        transport = open_transport(server.url, 115200)
        yield transport
        transport.close()


def _replies(port: OpenedTransport, *requests: str) -> str:
    """Send requests in hex; return the frame that is received."""
    port.write(bytes.fromhex("".join(requests)))
    received, until = b"", time.monotonic() + SECONDS
    while len(received) < 4 or len(received) < received[2] + 3:
        assert time.monotonic() < until, f"received only {received.hex(' ')}"
        received += port.read(0.05)
    return received.hex(" ").upper()


def _with_one_flag() -> list[str]:
    """Return the editions with the document's frames that report all servos by one flag."""
    tables = [editions.load(name).TABLE for name in editions.names()]
    return [
        table.edition
        for table in tables
        if table.frame.check is None
        and any(command.name == "is_all_servo_enable" for command in table.commands)
    ]


@pytest.mark.parametrize("edition", _with_one_flag())
def test_is_all_servo_enable_is_one_byte_that_is_1_when_all_are_on(port: OpenedTransport) -> None:
    assert _replies(port, ARE_ALL_ENABLED) == "FE FE 03 51 00 FA"
    assert _replies(port, POWER_ON, ARE_ALL_ENABLED) == "FE FE 03 51 01 FA"
    assert _replies(port, RELEASE_THE_THIRD, ARE_ALL_ENABLED) == "FE FE 03 51 00 FA"


@pytest.mark.parametrize("edition", ["mycobot280"])
@pytest.mark.parametrize(
    ("request_words", "reply"),
    [
        ("FE FE 05 53 01 15 01 FA", "FE FE 04 53 00 0A FA"),
        ("FE FE 05 53 01 18 01 FA", "FE FE 04 53 03 E8 FA"),
        ("FE FE 05 53 02 18 01 FA", "FE FE 04 53 00 00 FA"),
        ("FE FE 05 53 01 18 00 FA", "FE FE 03 53 E8 FA"),
        ("FE FE 04 53 01 18 FA", "FE FE 03 53 E8 FA"),
        ("FE FE 04 53 01 15 FA", "FE FE 03 53 0A FA"),
    ],
)
def test_servo_register_has_two_bytes_with_mode_1_and_else_one(
    port: OpenedTransport, request_words: str, reply: str
) -> None:
    assert _replies(port, WRITE_A_BYTE, WRITE_A_WORD, request_words) == reply


@pytest.mark.parametrize(
    ("words", "reply", "name", "why"),
    [
        ("FE FE 02 D4 FA", "FE FE 03 D4 01 FA", "move_round", "no source says"),
        ("FE FE 02 D7 FA", "FE FE 03 D7 01 FA", "set_four_pieces_zero", "four-piece motor"),
    ],
)
def test_command_without_effect_is_acknowledged_with_a_note(
    words: str, reply: str, name: str, why: str
) -> None:
    notes: list[Note] = []
    arm = SimulatedArm(editions.load("mycobot280").TABLE, powered=True, on_note=notes.append)
    with PtyServer(arm) as server:
        transport = open_transport(server.url, 115200)
        try:
            assert _replies(transport, words) == reply
        finally:
            transport.close()
    [note] = notes
    assert note.command == name
    assert why in note.text
