"""Every bad spec is rejected with exactly the expected place, code and message.

``author/test_explain.py`` shows each code that has an explanation with example lines.
"""

from __future__ import annotations

import json
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

from cobotwire_codegen.load import MOST_BYTES
from codegen.author import samples
from codegen.author.test_explain import WITHOUT_LINES

HERE = Path(__file__).parent
LAMP = (HERE / "lamp.yaml").read_text()
# The first lines of each delta over the lamp.
DELTA = """\
edition: lantern
base: lamp.yaml
class: Lantern
title: A lantern
doc: A lamp to carry.
"""
BAD: dict[str, Any] = YAML(typ="safe").load(HERE / "bad_specs.yaml")
ONE_FILE = BAD["one_file"] + [
    {"replace": {"safety: setting": f"safety: setting\n    effect: {text}"}, "problems": found}
    for text, found in BAD["effects"].items()
]


def _name(case: dict[str, Any]) -> str:
    return " ".join(": ".join(line.split(": ")[:2]) for line in case["problems"][:1]) or "good"


def _problems(path: Path) -> list[str]:
    return [str(problem) for problem in samples.problems(path)]


def test_unchanged_lamp_has_no_problem(tmp_path: Path) -> None:
    (tmp_path / "lamp.yaml").write_text(LAMP)
    assert _problems(tmp_path / "lamp.yaml") == []


@pytest.mark.parametrize("case", ONE_FILE, ids=_name)
def test_bad_file_is_reported_with_exact_problems(tmp_path: Path, case: dict[str, Any]) -> None:
    changed = LAMP
    for text, other in case["replace"].items():
        assert text in changed, "the case must change something"
        changed = changed.replace(text, other, 1)
    path = tmp_path / "lamp.yaml"
    path.write_text(changed)
    assert case["problems"]
    assert _problems(path) == case["problems"]


@pytest.mark.parametrize("case", BAD["delta"], ids=_name)
def test_bad_delta_is_reported_with_exact_problems(tmp_path: Path, case: dict[str, Any]) -> None:
    (tmp_path / "lamp.yaml").write_text(LAMP)
    (tmp_path / "lantern.yaml").write_text(DELTA + case["text"])
    assert _problems(tmp_path / "lantern.yaml") == case["problems"]


def test_every_code_without_example_lines_is_shown_by_a_bad_spec() -> None:
    shown = {
        line.split(": ")[1] for case in (*ONE_FILE, *BAD["delta"]) for line in case["problems"]
    }
    # Other tests show these codes, because the content of a single spec cannot cause them.
    elsewhere = {"no-edition", "unknown-rule"}
    assert WITHOUT_LINES - elsewhere <= shown


def test_unreadable_and_empty_files_are_reported_as_problems(tmp_path: Path) -> None:
    binary = tmp_path / "lamp.yaml"
    binary.write_bytes("édition: lamp\ntitle: ä ".encode() + b"\xff\xfe\n")
    assert _problems(binary) == [
        "lamp.yaml:2:10: unreadable: the byte FF is not UTF-8; save the file as UTF-8"
    ]
    empty = tmp_path / "empty.yaml"
    empty.write_text("")
    assert "empty.yaml:1:1: wrong-kind: the edition is a plain value, but must be a mapping" in (
        _problems(empty)
    )


@pytest.mark.parametrize("variant", ["text", "json", "github"])
def test_check_reports_all_problems_in_three_formats(tmp_path: Path, variant: str) -> None:
    path = tmp_path / "lamp.yaml"
    path.write_text(LAMP.replace("id: 0x30", "id: 0x130").replace("range: [1, 4]", "range: [4, 1]"))
    words = ("check", "lamp.yaml", "--format", variant)
    result = samples.run(tmp_path, *words)
    assert result.returncode == 2
    first = "range of the quantity channel must be [lowest, highest]"
    if variant == "json":
        problems = json.loads(result.stdout)
        assert problems[0]["code"] == "bad-range"
        assert (problems[0]["file"], problems[0]["line"], problems[0]["column"]) == (
            "lamp.yaml",
            23,
            34,
        )
    elif variant == "github":
        line = f"::error file=lamp.yaml,line=23,col=34,title=bad-range::{first}"
        assert line in result.stdout
    else:
        assert f"lamp.yaml:23:34: bad-range: {first}" in result.stderr


def test_folder_without_an_edition_is_reported_as_no_edition(tmp_path: Path) -> None:
    result = samples.run(tmp_path, "--root", str(tmp_path))
    assert result.returncode == 2
    assert "no-edition: there is no edition here" in result.stderr


def test_file_above_the_limit_of_bytes_is_refused_unread(tmp_path: Path) -> None:
    large = tmp_path / "lamp.yaml"
    large.write_text(LAMP + "# \N{SNOWMAN}\n" * (MOST_BYTES // 3))
    assert _problems(large) == [
        f"lamp.yaml:1:1: too-large: the file has more than {MOST_BYTES} bytes, the limit; divide it"
    ]


def test_files_of_an_edition_are_limited_together(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "v.yaml").write_text("errata: []\n" + "#" * 5000 + "\n")
    monkeypatch.setattr("cobotwire_codegen.build.parts.MOST_BYTES_TOGETHER", 10_000)
    lamp = tmp_path / "lamp.yaml"
    lamp.write_text(LAMP.replace("vectors:", "errata: [v.yaml, v.yaml]\nvectors:"))
    assert _problems(lamp) == [
        f"lamp.yaml:{_line(lamp, 'errata')}:18: too-large: with this file the edition has more "
        "than 10000 bytes, the limit"
    ]
    (tmp_path / "v.yaml").write_text("errata: []\n")
    monkeypatch.setattr("cobotwire_codegen.build.parts.MOST_NODES_TOGETHER", 400)
    assert _problems(lamp) == []
    lamp.write_text(LAMP.replace("vectors:", f"errata: [{'v.yaml, ' * 200}]\nvectors:"))
    assert "the edition has more than 400 values, the limit" in _problems(lamp)[0]


def _line(path: Path, start: str) -> int:
    lines = path.read_text().splitlines()
    return next(number for number, line in enumerate(lines, 1) if line.startswith(start))


def test_long_chain_of_bases_is_refused(tmp_path: Path) -> None:
    (tmp_path / "lamp0.yaml").write_text(LAMP)
    head = "class: Lamp\ntitle: A lamp\ndoc: A lamp.\n"
    for number in range(1, 13):
        text = f"edition: lamp{number}\nbase: lamp{number - 1}.yaml\n{head}"
        (tmp_path / f"lamp{number}.yaml").write_text(text)
    assert _problems(tmp_path / "lamp10.yaml") == []
    assert _problems(tmp_path / "lamp12.yaml") == [
        "lamp2.yaml:2:7: too-large: the edition has a chain of more than 10 bases, the limit"
    ]


def test_aliases_that_stand_for_a_billion_values_are_refused_at_once(tmp_path: Path) -> None:
    rows = ["a: &a [x, x, x, x, x, x, x, x, x, x]"]
    rows += [f"{b}: &{b} [{', '.join([f'*{a}'] * 10)}]" for a, b in pairwise("abcdefghi")]
    (tmp_path / "lamp.yaml").write_text("\n".join(rows))
    command = [sys.executable, "-m", "cobotwire_codegen", "check", "lamp.yaml"]
    # Converted without a limit, these values take minutes and gigabytes.
    result = subprocess.run(
        command, capture_output=True, text=True, check=False, cwd=tmp_path, timeout=60
    )
    assert result.returncode == 2
    assert "too-large: up to here the file has more than 200000 values" in result.stderr
