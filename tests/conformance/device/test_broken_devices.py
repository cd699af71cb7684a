"""A device broken by hand fails the test case and the command that name its fault.

Most broken devices are in tests/mutation and tests/defects; these are not.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import pytest

from cobotwire import editions
from cobotwire.conformance import Cause, Verdict
from conformance.device.testing import Altered, permissions, prepared, results_of

TABLE = editions.load("mycobot280").TABLE
Alter = Callable[[bytes, bytes, int], bytes]


def _of(command: str, change: Callable[[bytes], bytes]) -> Alter:
    """Change the replies to one command."""
    id = TABLE.command(command).id
    return lambda request, reply, count: (
        change(reply) if reply and request[3:4] == bytes([id]) else reply
    )


BROKEN: Mapping[str, tuple[Alter, str, str]] = {
    "a stray byte": (_of("get_coords", lambda a: a + b"\x07"), "reply-once", "get_coords"),
    "a frame that was not requested": (
        _of("get_coords", lambda a: a + bytes.fromhex("FE FE 03 12 01 FA")),
        "reply-once",
        "get_coords",
    ),
    "acknowledged by 0": (
        _of("set_color", lambda a: bytes.fromhex("FE FE 03 6A 00 FA")),
        "acknowledgement",
        "set_color",
    ),
    "unlike each other": (
        lambda request, reply, count: (
            reply[:4] + bytes([count % 256]) + reply[5:]
            if request[3:4] == b"\x01" and reply
            else reply
        ),
        "reply-repeats",
        "get_modify_version",
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_reply_fails_its_test_case_and_command(name: str) -> None:
    alter, case, command = BROKEN[name]
    found = results_of(prepared(TABLE, lambda arm: Altered(arm, alter)), command)
    assert case in {result.case for result in found if result.verdict is Verdict.FAIL}


def test_device_that_replies_sometimes_is_unstable() -> None:
    seen = 0

    def alter(request: bytes, reply: bytes, count: int) -> bytes:
        nonlocal seen
        seen += request[3:4] == b"\x2b"
        return b"" if request[3:4] == b"\x2b" and seen <= 2 else reply

    report = prepared(
        TABLE, lambda arm: Altered(arm, alter), permissions=permissions(), repeat=3
    ).run()
    [moving] = [r for r in report.results if (r.case, r.command) == ("query-replied", "is_moving")]
    assert moving.outcome == "fail (unstable)"
    assert "1 of 3 runs" in moving.reason


def test_optional_command_without_a_reply_is_not_supported() -> None:
    name = "get_tof_distance"
    alter = _of(name, lambda a: b"")
    tester = prepared(
        TABLE,
        lambda arm: Altered(arm, alter),
        permissions=permissions(),
        optional=frozenset({name}),
    )
    found = results_of(tester, name)
    assert Cause.NOT_SUPPORTED in {result.cause for result in found}
    assert Verdict.FAIL not in {result.verdict for result in found}
