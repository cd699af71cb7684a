"""Fixtures show every rule: two small specs, and all findings of their comparison."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

from cobotwire_codegen.diff import LEVELS, RULES, diff, diff_all
from cobotwire_codegen.model import Edition

Build = Callable[..., Edition]
FOLDER = Path(__file__).parent / "rules"
FIXTURES: dict[str, list[dict[str, Any]]] = {
    level: YAML(typ="safe").load(FOLDER / f"{level}.yaml") for level in LEVELS
}
ALL = [fixture for level in LEVELS for fixture in FIXTURES[level]]
# Rules that need whole folders; a test below covers them.
FOLDERS = {"edition-added", "edition-removed"}


def _rules(fixture: dict[str, Any]) -> list[str]:
    return [line.partition(":")[0] for line in fixture["says"]]


@pytest.mark.parametrize("fixture", ALL, ids=lambda fixture: _rules(fixture)[0])
def test_fixture_has_exactly_its_findings(fixture: dict[str, Any], build: Build) -> None:
    old, new = (
        build([*fixture.get(side, {}).items()], fixture.get("file", "base"))
        for side in ("before", "after")
    )
    found = diff(old, new)
    assert [f"{one.rule}: {one.where}: {one.message}" for one in found] == fixture["says"]


def test_every_rule_has_its_fixture() -> None:
    for level, fixtures in FIXTURES.items():
        shown = {rule for fixture in fixtures for rule in _rules(fixture)}
        assert {rule for rule in RULES if RULES[rule].level == level} - FOLDERS <= shown


def test_added_and_removed_editions_are_findings(build: Build) -> None:
    edition = build()
    [gone] = diff_all({"small": edition}, {})
    [came] = diff_all({}, {"small": edition})
    assert (gone.rule, gone.level, gone.message) == (
        "edition-removed",
        "api",
        "the edition small was removed",
    )
    assert (came.rule, came.level, came.where) == ("edition-added", "addition", "small")


def test_changed_deadline_of_the_transport_is_reported_once(build: Build) -> None:
    found = diff(build(), build([("deadline_ms: 500", "deadline_ms: 900")]))
    assert [one.where for one in found] == ["small/frame"]


def test_finding_of_a_type_is_not_repeated_for_its_fields(build: Build) -> None:
    """A range that a field narrows itself is a separate finding."""
    narrowed = ("{name: angle, type: angle}", "{name: angle, type: angle, range: [-90, 90]}")
    found = diff(build(), build([("range: [-180, 180]", "range: [-120, 120]"), narrowed]))
    assert [one.where for one in found] == [
        "small/types/angle",
        "small/commands/send_angle/request/angle",
    ]


def test_changes_of_a_delta_are_not_reported_as_a_changed_history(build: Build) -> None:
    base, delta = build(), build(file="delta")
    assert any(command.changes for command in delta.commands)
    assert not {found.rule for found in diff(base, delta)} & {"history-changed"}
