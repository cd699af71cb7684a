"""Mistakes in the file about the maker's library are reported with their place."""

from __future__ import annotations

from pathlib import Path

import pytest

from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.library import build_library
from vectors import edition

HEAD = """\
library: a library 1.0
absent: []
methods:
  send_angle: {parameters: [id, degree, speed, _async=False]}
classes:
  MyCobot:
    doc: An arm.
    module: mycobot
    edition: mycobot
    constructor: [port, baudrate=115200]
"""


def problems(tmp_path: Path, text: str) -> list[str]:
    path = tmp_path / "library.yaml"
    path.write_text(text)
    try:
        build_library(path, tmp_path, [edition()])
    except SpecError as error:
        return [str(problem) for problem in error.problems]
    return []


def test_correct_library_file_is_read(tmp_path: Path) -> None:
    assert problems(tmp_path, HEAD) == []


@pytest.mark.parametrize(
    ("wrong", "place", "says"),
    [
        ("    lacks: [send_angel]\n", "11:12", "did you mean send_angle?"),
        ("    methods: {go: {calls: send_angels}}\n", "11:19", "did you mean send_angles?"),
        (
            "    methods: {stop: {parameters: [why]}}\n",
            "11:21",
            "passes 1 parameters, but stop takes 0",
        ),
        ("    methods: {stop: {passes: [why]}}\n", "11:30", "has no parameter why"),
        (
            "    methods: {stop: {parameters: ['a=open()']}}\n",
            "11:34",
            "write name or name=default",
        ),
        ("    methods: {stop: {result: joind}}\n", "11:30", "did you mean joined?"),
        ("    like: MyCobot280\n", "1:1", "is not listed before it"),
        (
            "    methods: {go: {calls: stop, parameters: [speed], passes: ['1', angle]}}\n",
            "11:62",
            "has no parameter angle",
        ),
        (
            "    methods: {send_angle: {parameters: [id, degree, speed], ranges: [speed=1-100]}}\n",
            "11:69",
            "write parameter=lowest..highest",
        ),
        (
            "    methods: {send_angle: {parameters: [id, degree, speed], ranges: [size=1..100]}}\n",
            "11:69",
            "has the range size=1..100",
        ),
        ("    methods_of: MyCobots\n", "11:17", "did you mean MyCobot?"),
        ("    elsewhere: mycobots\n", "11:16", "did you mean mycobot?"),
        ("    helper: [Homing]\n", "11:5", "did you mean helpers?"),
    ],
)
def test_mistake_in_library_file_is_reported_with_its_place(
    tmp_path: Path, wrong: str, place: str, says: str
) -> None:
    found = problems(tmp_path, HEAD + wrong)
    assert any(each.startswith(f"library.yaml:{place}: ") and says in each for each in found), found


def test_unknown_edition_is_reported(tmp_path: Path) -> None:
    [found] = problems(tmp_path, HEAD.replace("edition: mycobot", "edition: mycobots"))
    assert found.startswith("library.yaml:9:14: ")
    assert "did you mean mycobot?" in found
