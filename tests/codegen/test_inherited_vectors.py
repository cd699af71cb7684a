"""A delta inherits the vectors of its base, derived again where only frames or ranges changed."""

from __future__ import annotations

import json
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from click.testing import CliRunner

import vectors
from cobotwire.protocol.robot import load_robot
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.cli import main
from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.model import Edition, Vector
from cobotwire_codegen.publish import edition_json

SPEC = vectors.ROOT / "spec" / "editions"
HEAD = """\
edition: trial
class: Trial
title: A trial
doc: A trial edition.
base: cobotwire:mycobot280
"""
WHY = 'why: A trial.\n    evidence: [{source: a trial, says: "so"}]\n'
CRC_FRAME = """\
frame:
  frame:
    header: FE FE
    check: crc16-modbus
    length_counts: [command, data, check]
    maximum_data: 24
    doc: LEN counts what follows it.
"""
FOUR_JOINTS = f"""\
joints: 4
changes:
  - change_type: [target_angles, target_radians, angles, measured_angles]
    set: {{items: {{j1: limited_angle, j2: limited_angle, j3: limited_angle, j4: limited_angle}}}}
    {WHY}"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "trial.yaml"


@lru_cache
def built(text: str = "", head: str = HEAD) -> Edition:
    """Return the edition of a delta; several tests compare with the unchanged one."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "trial.yaml"
        file.write_text(head + text)
        return build_edition(file, file.parent)


def vector(edition: Edition, name: str) -> Vector:
    return next(vector for vector in edition.vectors if vector.name == name)


def problems(edition: Edition) -> list[str]:
    with pytest.raises(SpecError) as caught:
        check(edition)
    return [f"{problem.code}: {problem.message}" for problem in caught.value.problems]


def test_unchanged_delta_inherits_every_vector_as_it_is() -> None:
    edition = built()
    check(edition)
    assert len(edition.vectors) > 300
    before = build_edition(SPEC / "mycobot280.yaml", SPEC)
    assert [(v.name, v.frame) for v in edition.vectors] == [
        (v.name, v.frame) for v in before.vectors
    ]
    derived = {vector.name for vector in edition.vectors if vector.derived}
    assert {"send-angle-request-nearest-word", "set-encoders-request-corners"} <= derived


def test_delta_with_another_frame_format_derives_every_vector_and_states_its_origin() -> None:
    edition = built(CRC_FRAME)
    check(edition)
    before = built()
    framed = [vector for vector in edition.vectors if vector.frame is not None]
    assert len(framed) == len([vector for vector in before.vectors if vector.frame is not None])
    for after in framed:
        assert after.derived is not None
        former = vector(before, after.name)
        origin = former.derived.frame if former.derived else former.frame
        assert after.derived.frame == origin
        assert after.values == former.values
        assert former.frame is not None
        assert after.frame is not None
        # LEN counts one byte more; header, id and data stay.
        assert after.frame[3:-2] == former.frame[3:-1]


def test_value_beyond_a_new_range_becomes_the_nearest_legal_one() -> None:
    speed = f"changes:\n  - change_type: speed\n    set: {{range: [1, 30]}}\n    {WHY}"
    edition = built(speed)
    check(edition)
    changed = [v for v in edition.vectors if v.derived and v.derived.edition == "mycobot280"]
    assert changed
    for after in changed:
        assert after.derived is not None
        assert dict(after.derived.values)["speed"] > 30  # type: ignore[operator]
        assert dict(after.values)["speed"] == 30


def test_first_joints_of_a_vector_remain_in_an_arm_with_fewer() -> None:
    limits = "types:\n  quantities:\n    limited_angle: "
    limits += "{wire: signed_word, scale: 1/100, unit: degree, range: [-90, 90], doc: Up to 90.}\n"
    before = vector(built(), "get-angles-reply-lowest-and-highest")
    after = vector(built(limits + FOUR_JOINTS), "get-angles-reply-lowest-and-highest")
    [(_, six)], [(_, four)] = before.values, after.values
    assert isinstance(six, tuple)
    assert isinstance(four, tuple)
    assert four == tuple(max(-90, min(90, angle)) for angle in six[:4])
    assert after.frame is not None
    assert after.frame[:4] == bytes.fromhex("FE FE 0A 20")


def test_changed_scale_is_not_derived_but_reported() -> None:
    edition = built(f"changes:\n  - change_type: length\n    set: {{scale: 1/5}}\n    {WHY}")
    found = problems(edition)
    assert "unencodable-vector: get-coords-reply-twos-complement: coords.x is not" in "".join(found)


def test_moved_id_is_in_the_derived_vectors() -> None:
    moved = f"changes:\n  - change: get_encoder\n    set: {{id: 0x7E}}\n    {WHY}"
    edition = built(moved)
    check(edition)
    after = vector(edition, "get-encoder-reply-limits")
    assert after.derived is not None
    assert after.frame is not None
    assert (after.derived.frame[3], after.frame[3]) == (0x3B, 0x7E)
    assert (after.frame[4:], after.values) == (after.derived.frame[4:], after.derived.values)


def test_vectors_of_a_removed_command_are_removed() -> None:
    edition = built(f"changes:\n  - remove: [get_coords, send_coords]\n    {WHY}")
    assert not {"get_coords", "send_coords"} & {vector.command for vector in edition.vectors}
    assert not [found for found in problems(edition) if "vector" in found.partition(":")[0]]


def test_vectors_of_a_renamed_command_show_its_new_name() -> None:
    edition = built(f"changes:\n  - rename: get_coords\n    to: get_pose\n    {WHY}")
    names = {vector.command for vector in edition.vectors}
    assert "get_pose" in names
    assert "get_coords" not in names


def test_missing_vectors_are_proposed_and_written(file: Path) -> None:
    file.write_text(HEAD + ADDED)
    shown = CliRunner().invoke(main, ["vectors", str(file)])
    assert shown.exit_code == 1
    assert "- name: set-fan-request\n  command: set_fan\n  direction: request\n" in shown.stdout
    assert "  values: {level: 40}\n" in shown.stdout
    written = CliRunner().invoke(main, ["vectors", str(file), "--write"])
    assert (written.exit_code, "prove nothing until compared" in written.output) == (0, True)
    check(build_edition(file, file.parent))
    again = CliRunner().invoke(main, ["vectors", str(file)])
    assert (again.exit_code, again.stdout) == (0, "")


ADDED = """\
commands:
  set_fan:
    id: 0x7E
    title: Set the fan
    doc: Sets the fan's level.
    safety: setting
    request:
      - {name: level, type: opening}
"""


@pytest.mark.parametrize(
    ("base", "message"),
    [
        ("nosuchpackage:arm", "no-package: the package nosuchpackage is not installed"),
        ("cobotwire:mycobot281", "ships no edition mycobot281; did you mean mycobot280?"),
        ("mycobot280", "there is no file mycobot280; did you mean cobotwire:mycobot280?"),
        ("mycobot280.yaml", "no file mycobot280.yaml; did you mean cobotwire:mycobot280?"),
        ("mycobot281", "there is no file mycobot281\n"),
        ("os:path", "no-package: the package os is not installed"),
    ],
)
def test_unknown_base_of_a_package_is_reported_with_its_place(
    file: Path, base: str, message: str
) -> None:
    file.write_text(HEAD.replace("cobotwire:mycobot280", base))
    result = CliRunner().invoke(main, ["check", str(file)])
    assert result.exit_code == 2
    assert "trial.yaml:5:7: " in result.output
    assert message in result.output


def test_delta_with_unknown_geometry_inherits_no_geometry() -> None:
    assert built().robot.geometry is not None
    unknown = built("geometry_unknown: No source gives the links.\n")
    assert unknown.robot.geometry is None
    robot = load_robot(json.loads(edition_json(unknown))["edition"])
    assert robot.why_no_geometry.endswith("is not known: No source gives the links.")
