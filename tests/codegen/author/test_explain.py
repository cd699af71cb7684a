"""Every problem code has an explanation, and its example lines cause that code."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
from textwrap import dedent, indent

import pytest
from ruamel.yaml import YAML

import vectors
from cobotwire_codegen.author.codes import CODES, Explanation
from cobotwire_codegen.language.edition import FILES
from cobotwire_codegen.language.records import Choice
from cobotwire_codegen.language.schema import records
from codegen.author import samples

SOURCES = vectors.ROOT / "codegen/src/cobotwire_codegen"
EXPLAINED: dict[str, list[str]] = YAML(typ="safe").load(Path(__file__).with_name("explained.yaml"))
# The samples cannot show these codes. Two are about a folder and a file of waivers; a sample
# without commands reports other problems first; the samples lack the right lines of the last two.
WITHOUT_LINES = {"no-edition", "unknown-rule", "no-command", "bad-size", "bad-count"}


def _calls() -> Iterator[tuple[str, ast.Call]]:
    for path in SOURCES.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Call):
                function = node.func
                name = function.attr if isinstance(function, ast.Attribute) else ""
                yield (function.id if isinstance(function, ast.Name) else name), node


# The position of the problem's code among the arguments of each function.
CODE_ARGUMENT = {"Problem": 1, "problem": 0, "note": 0, "_wrong": 3}
COMPUTED = {"f'unknown-{what}'", "code", "key.absent", "self.code", "self.empty[0]"}


def _described() -> Iterator[str]:
    """Return the codes that the description of the language names."""
    found = records(FILES.values())
    for record in (one for one in found if not isinstance(one, Choice)):
        for key in record.keys().values():
            yield from (key.absent, getattr(key.shape, "code", ""))
            yield (getattr(key.shape, "empty", None) or ("",))[0]


def _emitted() -> set[str]:
    """Return the codes in the sources and in the description, and those that ``find`` composes."""
    found = set(_described()) - {""}
    for name, call in _calls():
        code = CODE_ARGUMENT.get(name)
        argument = call.args[code] if code is not None and len(call.args) > code else None
        if isinstance(argument, ast.Constant):
            found.add(str(argument.value))
        elif argument is not None:
            assert ast.unparse(argument) in COMPUTED, ast.unparse(argument)
        if name == "find" and len(call.args) == 5:
            what = call.args[2]
            assert isinstance(what, ast.Constant)
            assert isinstance(what.value, str)
            found.add(f"unknown-{what.value}")
    return found


def test_explained_codes_are_exactly_the_reported_ones() -> None:
    assert _emitted() == set(CODES)


def test_samples_have_no_problem() -> None:
    for name in samples.EDITIONS:
        assert samples.problems(samples.FOLDER / name) == []


def _places(text: str, block: str) -> Iterator[tuple[int, int, str]]:
    """Return where the lines of a block occur in a text, at any indentation."""
    lines, size = text.splitlines(), block.count("\n") + 1
    for start in range(len(lines) - size + 1):
        piece = "\n".join(lines[start : start + size])
        if dedent(piece) == block:
            yield start, start + size, " " * (len(lines[start]) - len(lines[start].lstrip()))


def _with_wrong_lines(folder: Path, explanation: Explanation) -> Iterator[Path]:
    """Replace each correct block by the wrong one, in one file after another."""
    for path in sorted(folder.glob("*.yaml")):
        text = path.read_text()
        lines = text.splitlines()
        for start, end, margin in _places(text, explanation.right):
            wrong = indent(explanation.wrong, margin).splitlines()
            path.write_text("\n".join([*lines[:start], *wrong, *lines[end:]]) + "\n")
            yield path
        path.write_text(text)


@pytest.mark.parametrize("code", sorted(CODES.keys() - WITHOUT_LINES))
def test_wrong_lines_of_an_explanation_cause_exactly_the_stated_problems(
    tmp_path: Path, code: str
) -> None:
    folder = samples.copied(tmp_path)
    (folder / "photo.jpg").write_bytes(b"\xff\xd8\xff")
    reported = (
        samples.problems(folder / name)
        for _ in _with_wrong_lines(folder, CODES[code])
        for name in samples.EDITIONS
    )
    found = next(found for found in reported if code in {problem.code for problem in found})
    own = [f"{each.place}: {each.message}" for each in found if each.code == code]
    assert [*own, *sorted({each.code for each in found} - {code})] == EXPLAINED[code]


def test_explain_prints_all_parts_of_a_code(tmp_path: Path) -> None:
    result = samples.run(tmp_path, "explain", "cases-differ-in-size")
    assert result.returncode == 0
    for part in (CODES["cases-differ-in-size"].means, "Why: ", "Fix: ", "TURN: {type: pose}"):
        assert part in result.stdout


def test_explain_without_a_word_lists_all_codes(tmp_path: Path) -> None:
    lines = samples.run(tmp_path, "explain").stdout.splitlines()
    assert [line.split()[0] for line in lines] == sorted(CODES)


def test_explain_prints_all_parts_of_a_command() -> None:
    result = samples.run(vectors.ROOT, "explain", "send_angle")
    assert result.returncode == 0
    assert "send_angle: Send one joint to an angle (id 0x21, motion" in result.stdout
    assert "FE FE 06 21 01 00 00 14 FA: joint = 1, angle = 0, speed = 20" in result.stdout


def test_every_command_of_every_edition_can_be_explained() -> None:
    from cobotwire_codegen.author.describe import describe_command

    for edition in vectors.editions().values():
        for command in edition.commands:
            text = describe_command(edition, command)
            assert text.startswith(f"{command.name}: ")
            assert command.doc.split()[0] in text


def test_explain_uses_the_given_edition() -> None:
    result = samples.run(samples.FOLDER, "explain", "set_light", "--edition", "lamp2.yaml")
    assert "Differs from lamp: Changed set_light" in result.stdout
    assert "it shone red" in result.stdout


@pytest.mark.parametrize(
    ("word", "near"),
    [("cases-differ-in-siz", "cases-differ-in-size"), ("send_angel", "send_angle")],
)
def test_explain_suggests_the_nearest_word_for_an_unknown_one(word: str, near: str) -> None:
    result = samples.run(vectors.ROOT, "explain", word)
    assert result.returncode == 2
    assert f"did you mean {near}?" in result.stderr


def test_explain_prints_what_a_key_of_the_language_means(tmp_path: Path) -> None:
    lines = samples.run(tmp_path, "explain", "shares_id").stdout.splitlines()
    assert lines == ["shares_id of command: Commands that have the same id with other data."]
    assert "scale of quantity: " in samples.run(tmp_path, "explain", "scale").stdout
    assert "did you mean shares_id?" in samples.run(tmp_path, "explain", "share_id").stderr


def test_outside_of_a_clone_the_file_has_to_be_named(tmp_path: Path) -> None:
    unknown = samples.run(tmp_path, "explain", "bad-efect")
    assert (
        "bad-efect is neither a problem code nor a key; did you mean bad-effect?" in unknown.stderr
    )
    assert "name your own file" in samples.run(tmp_path, "vectors").stderr
