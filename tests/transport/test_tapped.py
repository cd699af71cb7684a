"""A link that shows what passes."""

from __future__ import annotations

import time

import pytest

from cobotwire import MyCobot
from cobotwire.errors import LinkError
from cobotwire.sim import PtyServer
from cobotwire.transport import Link, TappedLink, open_link
from transport.ends import FAST, Line

Seen = list[tuple[str, bytes, float]]


def tapped(link: Link) -> tuple[TappedLink, Seen]:
    seen: Seen = []
    return TappedLink(link, lambda *what: seen.append(what)), seen


def test_it_is_a_link_that_a_driver_takes(server: PtyServer) -> None:
    link, seen = tapped(open_link(server.url, FAST))
    assert isinstance(link, Link)
    with MyCobot(link) as arm:
        arm.power_on()
        assert arm.is_power_on() is True
    sent = b"".join(data for way, data, _ in seen if way == "sent")
    assert sent.startswith(bytes.fromhex("FE FE 02 10 FA"))
    assert any(way == "heard" for way, _, _ in seen)


@pytest.mark.parametrize("kind", ["serial", "socket"])
def test_each_chunk_is_shown_when_it_passes(kind: str) -> None:
    with Line(kind) as line:
        link, seen = tapped(line.link)
        line.end.say(b"half")
        assert link.read(1.0) == b"half"
        assert link.read(0.02) == b""
        line.end.say(b" and half")
        assert link.read(1.0) == b" and half"
        link.write(b"whole")
        taken = link.write_some(b"some")
        assert taken == 4
        assert [what[:2] for what in seen] == [
            ("heard", b"half"),
            ("heard", b" and half"),
            ("sent", b"whole"),
            ("sent", b"some"),
        ]
        times = [what[2] for what in seen]
        assert times == sorted(times)
        assert times[-1] <= time.monotonic()
        assert link.fileno() == line.link.fileno()
        assert link.low_latency == line.link.low_latency


def test_of_a_write_that_fails_what_was_taken_is_shown() -> None:
    with Line("serial") as line:
        link, seen = tapped(line.link)
        data = bytes(range(250)) * 100
        with pytest.raises(LinkError) as caught:
            link.write(data)
        assert seen[0][:2] == ("sent", data[: caught.value.written])
        link.reopen()
        link.close()
        with pytest.raises(LinkError, match="it is closed"):
            link.read(0)
