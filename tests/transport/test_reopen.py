"""A link that is opened again."""

from __future__ import annotations

import pytest

from cobotwire.errors import LinkError
from cobotwire.transport import open_link
from transport.ends import FAST, Line, TcpEnd


def test_a_server_that_comes_back_is_reached_again() -> None:
    with Line("socket") as line:
        assert isinstance(line.end, TcpEnd)
        for round_ in range(3):
            line.end.hang_up()
            with pytest.raises(LinkError):
                line.link.read(1.0)
            line.link.reopen()
            line.end.accept()
            line.end.say(b"%d" % round_)
            assert line.link.read(1.0) == b"%d" % round_


def test_a_port_that_is_still_there_is_opened_again() -> None:
    with Line("serial") as line:
        line.link.write(b"one")
        assert line.end.hear(3) == b"one"
        line.link.reopen()
        line.link.write(b"two")
        assert line.end.hear(3) == b"two"


def test_a_closed_link_may_be_opened_again() -> None:
    with Line("serial") as line:
        line.link.close()
        line.link.reopen()
        line.end.say(b"x")
        assert line.link.read(1.0) == b"x"


@pytest.mark.parametrize("kind", ["serial", "socket"])
def test_what_is_gone_cannot_be_opened_again_but_tried_again(kind: str) -> None:
    with Line(kind) as line:
        line.end.unplug()
        for _ in range(2):
            with pytest.raises(LinkError, match="cannot be opened"):
                line.link.reopen()
        with pytest.raises(LinkError, match="it is closed"):
            line.link.read(0)


def test_pyserials_other_urls_are_opened_again_too() -> None:
    link = open_link("loop://", FAST)
    assert link.kind == "loop"
    assert link.fileno() is None
    link.write(b"before")
    link.reopen()
    link.write(b"after")
    assert link.read(0.5).startswith(b"a")
    link.close()
    with pytest.raises(LinkError, match="it is closed"):
        link.write_some(b"x")
