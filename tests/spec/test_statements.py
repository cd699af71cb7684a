"""The spec agrees with second sources: names, descriptions and the maker's library."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest

import vectors
from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence, load
from cobotwire_codegen.model import Command
from pymycobot_classes import RobotLimit, without_port, written
from robots.arguments import plain
from robots.classes import ROBOTS
from spec_mutants.spec_files import PATHS, built
from spec_statements import STATEMENTS, effects, meanings, requests

EDITIONS = tuple(vectors.editions())
BY_MAKER = "The maker's library 4.0.7 sends the accepted values and raises for the refused ones."


# For each edition, how many calls have the same result as with the maker's class, and how many do
# not. A wrong limit, default or type of a request changes the numbers. After an
# intended change, write the new numbers on the page.
PAGE = (vectors.ROOT / "docs" / "robots.md").read_text("utf-8")
AGREEMENT = {
    edition: (int(alike), int(differ))
    for edition, alike, differ in re.findall(r"\| `(\w+)` \| (\d+) \| (\d+) \|\n", PAGE)
}


# The commands for which no call sends the bytes of the maker's class: that sends a query first, an
# argument of another size, or other units.
MERCURY = {
    "drag_teach_execute",
    "set_limit_switch",
    "tool_serial_set_baud",
    "tool_serial_set_timeout",
}
UNEQUAL = {
    **dict.fromkeys(("mercury_a1", "mercury_b1", "pro400", "pro630"), MERCURY),
    "mycobot": {
        *("set_encoder", "set_joint_max", "set_joint_min"),
        *("set_tool_reference", "set_world_reference"),
    },
    "mycobot280_rdkx5": {"is_in_position", "jog_increment_angle"},
    "pro450": {"jog_angle", "jog_coord", "jog_increment_angle", "jog_increment_coord", "jog_rpy"},
}


@pytest.mark.parametrize("edition", EDITIONS)
def test_edition_agrees_with_independent_statements(edition: str) -> None:
    # The next test covers requests.
    independent = [each for each in STATEMENTS if each not in requests.RULES]
    said = [text for statement in independent for text in statement(vectors.edition(edition))]
    assert said == []


@pytest.mark.parametrize("edition", sorted(AGREEMENT))
def test_as_many_calls_agree_with_the_makers_class_as_the_page_says(edition: str) -> None:
    alike, differ = requests.compared(edition)
    assert (len(alike), differ) == AGREEMENT[edition]
    assert requests.unequal(edition) == UNEQUAL.get(edition, set())


def test_every_class_has_a_row_of_agreement_and_only_methods_that_it_has() -> None:
    assert {*AGREEMENT} == {robot.edition for robot in ROBOTS.values()}
    for robot in ROBOTS.values():
        lacking = [robot.method(robot.table.command(name)) for name in robot.lacking]
        assert not {*lacking} & {*robot.public}
        assert {*robot.methods.values(), *robot.not_ours} <= {*robot.public}


def test_every_pattern_of_a_meaning_describes_a_command() -> None:
    commands = [command for name in PATHS for command in built(name).commands]
    said = [(effect, name, doc) for name, doc, effect in effects.EFFECTS]
    for word, name, doc in (*meanings.SAFETY, *meanings.ROLES, *said):
        assert any(meanings.fits(command, name, doc) for command in commands), (word, name)


def _limits_by_maker() -> set[str]:
    """Return the names of the vectors that quote the library for their limits."""
    root = load(vectors.ROOT / "spec" / "editions" / "mycobot280" / "vectors" / "limits.yaml")
    assert isinstance(root, Mapping)
    listed = root.entries["vectors"]
    assert isinstance(listed, Sequence)
    found = [item.entries for item in listed.items if isinstance(item, Mapping)]
    return {
        _text(each["name"]) for each in found if "why" in each and _text(each["why"]) == BY_MAKER
    }


def _text(node: Node) -> str:
    return str(node.value) if isinstance(node, Scalar) else ""


def _sends(command: Command, values: dict[str, Any]) -> bool:
    """Return whether MyCobot280 sends a request with these values."""
    constants = {f.name for variant in command.requests for f in variant if f.const is not None}
    given = [plain(value) for name, value in values.items() if name not in constants]
    if "radians" in values:
        given[0] = [math.radians(angle) for angle in values["radians"]]
    try:
        written(without_port("MyCobot280"), command.name, given)
    except Exception:  # any: the library rejects values in many ways
        return False
    return True


def test_limits_that_vectors_quote_are_those_of_the_makers_library() -> None:
    edition = vectors.edition("mycobot280")
    commands = {command.name: command for command in edition.commands}
    by_maker = _limits_by_maker()
    compared = 0
    for vector in edition.vectors:
        if vector.name in by_maker:
            for values, legal in vectors.limits("mycobot280", vector):
                assert _sends(commands[vector.command], values) == legal, (vector.name, values)
                compared += 1
    assert compared > 300


# Sentences of evidence that name a class of the library and its joints.
LIMIT = re.compile(r"(\w+): joint (\d) from (-?\d+) to (-?\d+) degrees")
JOINTS = re.compile(r"tables? of (\w+)(?: and (\w+))?: joints 1 to (\d)")


def test_tables_that_evidence_quotes_are_those_of_the_library() -> None:
    tables = RobotLimit.robot_limit
    spec = "\n".join(p.read_text() for p in sorted((vectors.ROOT / "spec").rglob("*.yaml")))
    limits, joints = set(LIMIT.findall(spec)), set(JOINTS.findall(spec))
    assert len(limits) == 6
    assert joints == {("Pro630", "Pro450Client", "6")}
    for name, joint, lowest, highest in limits:
        ends = [tables[name][key][int(joint) - 1] for key in ("angles_min", "angles_max")]
        assert ends == [int(lowest), int(highest)], (name, joint)
    for *names, last in joints:
        assert all(tables[n]["joint_id"] == [*range(1, int(last) + 1)] for n in names if n)
    # The evidence for the Pro 400 says that the library has no table for it.
    assert "Pro400" not in tables
