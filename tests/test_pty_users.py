"""Tests that need a pseudo-terminal are marked, and no others."""

from __future__ import annotations

from pathlib import Path

import pytest

from pty_users import needs_pty

TESTS = Path(__file__).parent


@pytest.mark.parametrize(
    ("module", "expected"),
    [
        ("transport/test_port.py", True),  # imports termios
        ("simulator/test_pty.py", True),  # starts a server on a pty
        ("client/test_field_notes.py", True),  # a helper does
        ("codec/test_framing_laws.py", False),
        ("protocol", False),
    ],
)
def test_module_needs_a_pty_if_it_or_a_helper_opens_one(module: str, expected: bool) -> None:
    path = TESTS / module
    files = [path] if path.suffix else sorted(path.glob("test_*.py"))
    assert files
    assert {needs_pty(file) for file in files} == {expected}


def test_fixture_of_a_pty_marks_its_test(request: pytest.FixtureRequest, server: object) -> None:
    assert request.node.get_closest_marker("pty")


def test_test_without_a_pty_has_no_mark(request: pytest.FixtureRequest) -> None:
    assert not request.node.get_closest_marker("pty")
