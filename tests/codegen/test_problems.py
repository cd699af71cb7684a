"""A bad spec is refused with file, line, column, what is wrong, and the nearest right spelling."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import vectors
from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.project import editions

TYPES, COORDS, DOCUMENT = "types.yaml", "commands/coords.yaml", "vectors/document.yaml"

# Each: the file, what stands in it, what takes its place, and what the generator says of it. The
# place is where the replaced text starts, unless the problem shows elsewhere.
BAD = [
    ("unknown key", COORDS, "    safety: query\n", "    safty: query\n", "unknown-key: the command get_coords has no key safty; did you mean safety?"),
    ("missing key", COORDS, "    title: Read the coordinates\n", "", "missing-key: the command get_coords lacks the key title"),
    ("unknown word", COORDS, "safety: query", "safety: querry", "unknown-word: safety of the command get_coords cannot be querry; did you mean query?"),
    ("unknown type", COORDS, "is: move_mode", "is: move_mod", "unknown-type: there is no type move_mod; did you mean move_mode?"),
    ("duplicate key", COORDS, "    id: 0x23\n", "    id: 0x23\n    id: 0x23\n", "duplicate-key: id stands already in line"),
    ("syntax", COORDS, "safety: query", "safety: [query", "syntax: "),
    ("a word for an id", COORDS, "id: 0x23", "id: twenty", "wrong-kind: id of the command get_coords must be a whole number"),
    ("an id that is no byte", COORDS, "id: 0x23", "id: 0x123", "bad-id: the id 0x123 is no byte"),
    ("an ambiguous layout", COORDS, "id: 0x23", "id: 0x20", "ambiguous-layout: the request of get_coords has the id 0x20 and 0 data bytes"),
    ("a keyword for a name", COORDS, "name: speed, is: speed}\n    disputed", "name: class, is: speed}\n    disputed", "bad-name: class cannot be a name here"),
    ("a field twice", COORDS, "name: mode, is", "name: speed, is", "duplicate-field: speed stands twice"),
    ("an unknown selector", COORDS, "by: axis", "by: axs", "bad-selector: by: axs must name an enum field"),
    ("a missing case", COORDS, "          RZ: {is: rotation}\n", "", "missing-case: the field coord of the command send_coord has no case for RZ"),
    ("an unknown case", COORDS, "          RZ: {is: rotation}\n", "          RZZ: {is: rotation}\n", "unknown-case: RZZ is no open case; did you mean RZ?"),
    ("uneven cases", COORDS, "          RZ: {is: rotation}\n", "          RZ: {is: speed}\n", "uneven-cases: the cases of coord differ in length"),
    ("a query without a reply", COORDS, "    reply:\n      - {name: coords, is: coords}\n", "", "mute-query: the query get_coords has no reply"),
    ("a dispute without evidence", TYPES, "        evidence:\n          - {source: document, lines: [1732]", "        proof:\n          - {source: document, lines: [1732]", "no-evidence: a disputed fact must carry its evidence"),
    ("an unsayable range", TYPES, "    wire: word\n    range: [1, 65535]", "    wire: word\n    scale: 2\n    range: [1, 65535]", "unsayable-range: the range of port falls between two steps of 2"),
    ("a range beyond the wire", TYPES, "range: [1, 65535]", "range: [1, 65536]", "range-too-wide: the range of port is wider than its wire type: 0..65535"),
    ("a range upside down", TYPES, "range: [1, 65535]", "range: [65535, 1]", "bad-range: range of the quantity port must be [lowest, highest]"),
    ("an unknown wire type", TYPES, "    wire: word\n    range: [1, 65535]", "    wire: wrod\n    range: [1, 65535]", "unknown-wire: there is no wire type wrod; did you mean word?"),
    ("an unknown unit", TYPES, "unit: millimetre", "unit: milimetre", "unknown-word: unit of the quantity length cannot be milimetre; did you mean millimetre?"),
    ("a member twice", TYPES, "TOOL: {value: 1,", "TOOL: {value: 0,", "duplicate-value: TOOL and FLANGE are both 0"),
    ("a member too wide", TYPES, "TOOL: {value: 1,", "TOOL: {value: 256,", "value-too-wide: TOOL = 256 does not fit into byte"),
    ("a vector that differs", DOCUMENT, "values: {axis: X, coord: 200, speed: 20}", "values: {axis: X, coord: 201, speed: 20}", "vector-differs: example-19: the values build FE FE 06 24 01 07 DA 14 FA"),
    ("a vector of nothing", DOCUMENT, "command: send_coord\n", "command: send_cord\n", "unknown-command: there is no command send_cord; did you mean send_coord?"),
    ("a tag", COORDS, "safety: query", "safety: !!python/name:os.system query", "bad-tag: "),
]  # fmt: skip


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    """A copy of the project's spec that a test may spoil."""
    shutil.copytree(vectors.ROOT / "spec", tmp_path / "spec")
    return tmp_path


@pytest.mark.parametrize(
    ("file", "old", "new", "said"), [b[1:] for b in BAD], ids=[b[0] for b in BAD]
)
def test_a_bad_spec_is_refused_with_its_place(
    spec: Path, file: str, old: str, new: str, said: str
) -> None:
    path = spec / "spec" / file
    text = path.read_text()
    assert old in text, "the test must spoil something"
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(SpecError) as caught:
        editions(spec)
    lines = [str(problem) for problem in caught.value.problems]
    match = next((line for line in lines if said in line), None)
    assert match is not None, lines
    place, _, _ = match.partition(": ")
    name, line, column = place.rsplit(":", 2)
    assert name.startswith("spec/")
    assert int(line) >= 1
    assert int(column) >= 1


def test_the_place_is_the_very_line_and_column(spec: Path) -> None:
    path = spec / "spec" / COORDS
    lines = path.read_text().splitlines()
    row = next(index for index, line in enumerate(lines) if "safety: query" in line)
    lines[row] = lines[row].replace("safety", "safty")
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(SpecError) as caught:
        editions(spec)
    place = next(p.place for p in caught.value.problems if p.code == "unknown-key")
    assert str(place) == f"spec/commands/coords.yaml:{row + 1}:5"


def test_all_problems_are_told_at_once(spec: Path) -> None:
    path = spec / "spec" / COORDS
    path.write_text(
        path.read_text().replace("is: speed", "is: sped").replace("is: axis", "is: axs")
    )
    with pytest.raises(SpecError) as caught:
        editions(spec)
    unknown = [p for p in caught.value.problems if p.code == "unknown-type"]
    assert len(unknown) == 3


def test_a_missing_file_is_named(spec: Path) -> None:
    (spec / "spec" / TYPES).unlink()
    with pytest.raises(SpecError, match=r"spec/editions/mycobot\.yaml:\d+:\d+: no-file: .*types"):
        editions(spec)
