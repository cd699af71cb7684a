"""``new-command`` checks a new command, adds it to the right files, and changes nothing else."""

from __future__ import annotations

from pathlib import Path

import pytest

from cobotwire_codegen.build import build_edition
from codegen.author import samples
from codegen.test_generator import copy_spec

WORDS = ["--name", "dim", "--id", "0x70", "--title", "Dim: a little", "--doc", "Dims the lamp."]
SETTING = [*WORDS, "--safety", "setting"]


def _new(folder: Path, edition: str, *words: str) -> tuple[int, str]:
    result = samples.run(folder, "new-command", "--edition", edition, *words)
    return result.returncode, result.stdout + result.stderr


def _texts(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in folder.rglob("*.yaml")}


def _kept(before: dict[str, str], after: dict[str, str]) -> None:
    """Check that every earlier line is still there, in its order."""
    for name, text in before.items():
        rest = iter(after[name].splitlines())
        assert all(line in rest for line in text.splitlines()), name


def test_new_command_is_inserted_into_the_middle_of_a_one_file_protocol(tmp_path: Path) -> None:
    folder = samples.copied(tmp_path)
    before = _texts(folder)
    code, output = _new(folder, "lamp.yaml", *SETTING, "--request", "joint:joint,angle:angle")
    assert code == 0, output
    assert samples.problems(folder / "lamp.yaml") == []
    _kept(before, _texts(folder))
    edition = build_edition(folder / "lamp.yaml", folder)
    assert edition.commands[-1].title == "Dim: a little"
    assert edition.vectors[-1].frame == bytes.fromhex("FE FE 05 70 02 22 08 FA")


def test_new_command_is_added_to_the_familys_file_and_missing_yaml(tmp_path: Path) -> None:
    copy_spec(tmp_path)
    before = {path: path.read_text() for path in (tmp_path / "spec").rglob("*.yaml")}
    words = ["--family", "gripper", "--name", "get_load", "--id", "0x7E", "--title", "Read it"]
    query = ["--doc", "Reads it. " * 12, "--safety", "query", "--source", "12-13"]
    fields = ["--request", "joint:joint", "--reply", "joint:joint:echo,load:angle"]
    seen = ["--vector", "FE FE 03 7E 02 FA", "--reply-values", "joint: 2, load: -1.5"]
    result = samples.run(tmp_path, "new-command", *words, *query, *fields, *seen)
    assert result.returncode == 0, result.stderr
    changed = [path.name for path, text in before.items() if path.read_text() != text]
    assert sorted(changed) == ["gripper.yaml", "missing.yaml"]
    for path, text in before.items():
        assert path.read_text().startswith(text.rstrip())
    added = (tmp_path / "spec/vectors/missing.yaml").read_text()
    assert "frame: FE FE 03 7E 02 FA\n    values: {joint: 2}\n" in added
    assert "frame: FE FE 05 7E 02 FF 6A FA\n    values: {joint: 2, load: -1.5}\n" in added
    assert samples.run(tmp_path, "check").returncode == 0


WRONG = {
    "an id in use": (["--id", "0x21", "--request", "joint:joint,lit:flag"], "ambiguous-variant"),
    "a name in use": (["--name", "move"], "duplicate-"),
    "no name": (["--name", "x # y"], "a method's name"),
    "a keyword": (["--name", "class"], "bad-name"),
    "a query without a reply": (["--safety", "query"], "query-without-reply"),
    "an unknown type": (["--request", "joint:jiont"], "did you mean joint?"),
    "an unknown class": (["--safety", "seting"], "did you mean setting?"),
    "no field": (["--request", "joint"], "joint is not"),
    "another frame": (["--vector", "FE FE 02 71 FA"], "is not the described request"),
    "no hex": (["--vector", "FE F"], "vector"),
    "a value outside": (["--request", "j:joint", "--values", "j: 9"], "allowed: 1..2"),
    "another field": (["--request", "j:joint", "--values", "k: 1"], "vector"),
    "no number": (["--id", "seven"], "0x7E"),
}


@pytest.mark.parametrize(("words", "message"), WRONG.values(), ids=WRONG.keys())
def test_new_command_with_bad_input_reports_it_and_writes_nothing(
    tmp_path: Path, words: list[str], message: str
) -> None:
    folder = samples.copied(tmp_path)
    before = _texts(folder)
    code, output = _new(folder, "lamp.yaml", *SETTING, *words)
    assert code == 2
    assert message in output
    assert _texts(folder) == before


def test_new_command_without_a_terminal_names_missing_options(tmp_path: Path) -> None:
    folder = samples.copied(tmp_path)
    code, output = _new(folder, "bus.yaml", "--name", "dim")
    assert code == 2
    assert "missing: --family, --id, --title, --doc, --safety" in output


def test_dry_run_prints_entries_and_writes_nothing(tmp_path: Path) -> None:
    folder = samples.copied(tmp_path)
    before = _texts(folder)
    code, output = _new(folder, "lamp.yaml", *SETTING, "--dry-run")
    assert code == 0
    assert "  dim:\n    id: 0x70\n" in output
    assert "    frame: FE FE 02 70 FA\n" in output
    assert _texts(folder) == before


def test_new_command_of_an_edition_with_acks_gets_vectors_of_acks(tmp_path: Path) -> None:
    folder = samples.copied(tmp_path)
    words = ["--family", "all", "--request", "lit:flag", "--vector", "FE FE 01 03 70 01 71"]
    code, output = _new(folder, "bus.yaml", *SETTING, *words)
    assert code == 0, output
    edition = build_edition(folder / "bus.yaml", folder)
    added = [vector.name for vector in edition.vectors[-3:]]
    assert added == ["dim-request", "dim-reply", "dim-reply-2"]


def test_new_command_of_a_delta_is_added_to_the_deltas_files(tmp_path: Path) -> None:
    copy_spec(tmp_path)
    edition = "spec/editions/mycobot280.yaml"
    code, output = _new(tmp_path, edition, *SETTING, "--id", "0xEE", "--family", "gripper")
    assert code == 0, output
    assert samples.run(tmp_path, "check", edition).returncode == 0


def test_new_command_begins_the_commands_of_a_delta_that_has_none(tmp_path: Path) -> None:
    folder = samples.copied(tmp_path)
    delta = folder / "lantern.yaml"
    delta.write_text(
        "edition: lantern\nclass: Lantern\ntitle: A lantern\ndoc: A lamp.\nbase: lamp.yaml\n"
    )
    assert samples.problems(delta) == []
    code, output = _new(folder, "lantern.yaml", *SETTING, "--request", "joint:joint")
    assert code == 0, output
    assert samples.problems(delta) == []
    assert "\ncommands:\n  dim:\n" in delta.read_text()
    assert "\nvectors:\n" in delta.read_text()
