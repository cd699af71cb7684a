"""The call at the top of each command's reference sends its frame and returns what it shows."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from contextlib import suppress
from importlib import import_module
from itertools import product
from typing import Any, NamedTuple

import pytest

import vectors
from cobotwire.editions import load, names
from cobotwire.protocol.errors import ReplyTimeout
from cobotwire.simulator import MemoryTransport, SteppedClock
from cobotwire_codegen.render import render_reference
from memory_peer import MemoryPeer

SECTION = re.compile(r"^## (\w+)$(.*?)(?=^## |\Z)", re.DOTALL | re.MULTILINE)
# A section begins with its call.
CALL = re.compile(r"\n\n```pycon\n>>> (arm\..*)\n(?:(.*)\n)?```$", re.MULTILINE)
# A message without fields is shown as its only frame, others as boxes with example bytes below.
MESSAGE = re.compile(
    r"^\*\*(Request|Reply)\*\*(?: \([\w ]+\))?(?:: `([0-9A-F ]+)`$|\n\n```text\n(.*?)```)",
    re.MULTILINE | re.DOTALL,
)
# The text of a reply without a frame.
TEXT = re.compile(r"^    (.*)$", re.MULTILINE)
HEX = re.compile(r"[0-9A-F ]+\Z")


class Example(NamedTuple):
    """What the page of a command shows: the frames are those of every variant."""

    call: str
    returned: str
    requests: list[bytes]
    replies: list[bytes]


def examples(edition: str) -> Iterator[Example]:
    for page in render_reference(vectors.edition(edition)).values():
        for section in SECTION.finditer(page):
            if call := CALL.match(section[2]):
                yield Example(
                    call[1],
                    call[2] or "",
                    list(frames(section[2], "Request")),
                    [*frames(section[2], "Reply"), *texts(section[2])],
                )


def frames(section: str, direction: str) -> Iterator[bytes]:
    for message in MESSAGE.finditer(section):
        if message[1] == direction:
            lines = [message[2]] if message[2] else message[3].splitlines()[4::5]
            if lines and all(map(HEX.match, lines)):
                yield bytes.fromhex("".join(lines))


def texts(section: str) -> list[bytes]:
    return [text[1].encode() for text in TEXT.finditer(section)]


def equal(got: object, wanted: object) -> bool:
    """Return whether two values have the same type; radians are shown with five digits."""
    if isinstance(got, float) and isinstance(wanted, float):
        return math.isclose(got, wanted, rel_tol=1e-4)
    if isinstance(got, tuple) and type(got) is type(wanted) and len(got) == len(wanted):
        return all(map(equal, got, wanted))
    return type(got) is type(wanted) and got == wanted


def run(edition: str, example: Example) -> str:
    """Return what is wrong with an example; empty if its call does what the page says."""
    module = load(edition)
    found = [import_module(f"cobotwire.editions.{edition}.{name}") for name in ("enums", "values")]
    known: dict[str, Any] = {name: value for each in found for name, value in vars(each).items()}
    at = module.TABLE.frame.address_at
    sent, returned = [], []
    # The examples of a request and of its reply may have different addresses.
    frames = [*example.requests, *example.replies]
    addresses = [None] if at is None else dict.fromkeys(frame[at] for frame in frames)
    for address, reply in product(addresses, example.replies or [b""]):
        device = MemoryPeer(then=reply)
        with module.CLIENT(MemoryTransport(device, SteppedClock()), on_error="leave") as client:
            arm: Any = client if address is None else client.at(address)
            with suppress(ReplyTimeout):
                returned.append(eval(example.call, {**known, "arm": arm}))
        sent.append(device.writes[-1] if device.writes else b"")
    if not any(data.startswith(request) for data in sent for request in example.requests):
        return f"sent {[data.hex(' ').upper() for data in sent]}"
    wanted = eval(example.returned, known) if example.returned else None
    return "" if any(equal(got, wanted) for got in returned) else f"returned {returned}"


@pytest.mark.parametrize("edition", names())
def test_example_of_every_command_sends_its_frame_and_returns_its_value(edition: str) -> None:
    every = list(examples(edition))
    commands = load(edition).TABLE.commands
    assert len(every) == sum(not command.event for command in commands) > 40
    wrong = {each.call: problem for each in every if (problem := run(edition, each))}
    assert wrong == {}
