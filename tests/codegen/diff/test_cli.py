"""``cobotwire-gen diff`` on the command line: formats, waivers, exit codes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from cobotwire_codegen.cli import main

BASE = (Path(__file__).parent / "base.yaml").read_text()
BREAKING = ("id: 0x22", "id: 0x23")
WAIVED = "- {rule: id-changed, where: small/commands/jog, reason: No firmware ever had it.}\n"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Change to a folder that holds the old side of every comparison."""
    (tmp_path / "old.yaml").write_text(BASE)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*swaps: tuple[str, str], words: tuple[str, ...] = (), waivers: str = "") -> Result:
    text = BASE
    for take, put in swaps:
        assert take in text
        text = text.replace(take, put)
    Path("new.yaml").write_text(text)
    Path("waivers.yaml").write_text(waivers)
    given = ("--waivers", "waivers.yaml") if waivers else ()
    return CliRunner().invoke(main, ["diff", "old.yaml", "new.yaml", *given, *words])


def test_diff_of_equal_specs_reports_no_difference() -> None:
    result = run()
    assert (result.exit_code, result.output) == (0, "no difference\n")


def test_report_groups_findings_by_level() -> None:
    result = run(BREAKING, ("doc: A frame.", "doc: Frame."), ("class: Axis", "class: Way"))
    assert result.exit_code == 1
    assert result.output == (
        "wire (1): breaks the protocol: old and new peers misunderstand each other\n"
        "  id-changed: small/commands/jog: the id changed from 0x22 to 0x23: requests reach "
        "another command, or none\n"
        "api (1): breaks callers of the generated Python\n"
        "  class-renamed: small/types/axis: the class Axis is now Way\n"
        "docs (1): words and evidence\n"
        '  doc-changed: small/frame: changed from "A frame." to "Frame."\n'
        "1 wire, 1 api, 1 docs; version bump: major (before 1.0: minor)\n"
    )


@pytest.mark.parametrize(
    ("swap", "bump", "code"),
    [
        (BREAKING, "major (before 1.0: minor)", 1),
        (("class: Axis", "class: Way"), "major (before 1.0: minor)", 1),
        (("range: [0, 100]", "range: [0, 50]"), "minor (before 1.0: minor)", 1),
        (("echo: required", "echo: optional"), "minor (before 1.0: minor)", 1),
        (("  ssid: {}", "  ssid: {}\n  tone: {}"), "minor (before 1.0: patch)", 0),
        (("doc: A frame.", "doc: Frame."), "patch (before 1.0: patch)", 0),
    ],
)
def test_version_bump_and_exit_code_follow_from_the_findings(
    swap: tuple[str, str], bump: str, code: int
) -> None:
    result = run(swap)
    assert result.output.endswith(f"version bump: {bump}\n")
    assert result.exit_code == code


@pytest.mark.parametrize(
    ("fail_on", "codes"),
    [
        ("wire", (1, 0, 0)),
        ("api", (1, 1, 0)),
        ("behaviour", (1, 1, 1)),
        ("none", (0, 0, 0)),
    ],
)
def test_fail_on_names_the_least_severe_level_that_fails(
    fail_on: str, codes: tuple[int, int, int]
) -> None:
    swaps = BREAKING, ("class: Axis", "class: Way"), ("safety: query", "safety: motion")
    found = tuple(run(swap, words=("--fail-on", fail_on)).exit_code for swap in swaps)
    assert found == codes


def test_diff_prints_json() -> None:
    result = run(BREAKING, words=("--format", "json"))
    assert result.exit_code == 1
    assert json.loads(result.output) == {
        "format": "cobotwire-diff",
        "version": 2,
        "old": "old.yaml",
        "new": "new.yaml",
        "bump": "major",
        "bump_before_1_0": "minor",
        "findings": [
            {
                "rule": "id-changed",
                "level": "wire",
                "where": "small/commands/jog",
                "old": "0x22",
                "new": "0x23",
                "message": (
                    "the id changed from 0x22 to 0x23: requests reach another command, or none"
                ),
            }
        ],
        "waived": [],
        "unused_waivers": [],
    }


def test_diff_prints_markdown() -> None:
    result = run(BREAKING, ("A frame.", "One *frame*."), words=("--format", "markdown"))
    assert result.output == (
        "### Wire-breaking\n\n"
        "- `small/commands/jog`: the id changed from 0x22 to 0x23: requests reach another command, "
        "or none (`id-changed`)\n\n"
        "### Docs\n\n"
        '- `small/frame`: changed from "A frame." to "One \\*frame\\*." (`doc-changed`)\n\n'
        "1 wire, 1 docs; version bump: major (before 1.0: minor)\n"
    )


def test_waived_findings_are_shown_and_not_counted() -> None:
    result = run(BREAKING, waivers=WAIVED)
    assert result.exit_code == 0
    assert result.output == (
        "waived (1): accepted, and not counted\n"
        "  id-changed: small/commands/jog: the id changed from 0x22 to 0x23: requests reach "
        "another command, or none\n"
        "    because: No firmware ever had it.\n"
        "no difference except those waived\n"
    )
    document = json.loads(run(BREAKING, waivers=WAIVED, words=("--format", "json")).output)
    assert (document["bump"], document["findings"]) == ("none", [])
    assert document["waived"][0]["reason"] == "No firmware ever had it."
    shown = run(BREAKING, waivers=WAIVED, words=("--format", "markdown")).output
    assert "### Waived\n\n- `small/commands/jog`: " in shown
    assert "Waived: No firmware ever had it." in shown


def test_waiver_applies_to_one_rule_at_one_place() -> None:
    result = run(BREAKING, ("id: 0x21", "id: 0x24"), waivers=WAIVED)
    assert result.exit_code == 1
    assert "1 wire; version bump: major" in result.output


def test_unused_waiver_is_reported() -> None:
    result = run(waivers=WAIVED)
    assert result.exit_code == 0
    unused = "unused-waiver: id-changed at small/commands/jog matches nothing; remove it"
    assert f"waivers.yaml:1:3: {unused}\n" in result.output
    document = json.loads(run(waivers=WAIVED, words=("--format", "json")).output)
    assert document["unused_waivers"] == [
        {"rule": "id-changed", "where": "small/commands/jog", "place": "waivers.yaml:1:3"}
    ]
    assert "> Unused waiver: " in run(waivers=WAIVED, words=("--format", "markdown")).output


@pytest.mark.parametrize(
    ("waivers", "message"),
    [
        ("- {rule: id-changed, where: a}", "1:3: missing-key: a waiver lacks the key reason"),
        ("- {rule: id-changed, where: a, reason: ''}", "1:40: wrong-kind: reason of a waiver"),
        ("- {rule: id-changed, where: a, reason: ' '}", "1:40: wrong-kind: reason of a waiver"),
        (
            "- {rule: id-changd, where: a, reason: b}",
            "1:10: unknown-rule: there is no rule id-chan",
        ),
        ("- {rule: x, where: a, reason: b}", "there is no rule x; `cobotwire-gen diff --rules`"),
        ("- {rule: id-changed, where: a, reason: b, by: c}", "1:43: unknown-key: a waiver has no"),
        ("rule: id-changed", "1:1: wrong-kind: waivers are a list of {rule, where, reason}"),
        ("- id-changed", "1:3: wrong-kind: a waiver is a plain value"),
        ("- {rule: [", "syntax: "),
    ],
)
def test_bad_waiver_is_reported_with_its_place(waivers: str, message: str) -> None:
    result = run(BREAKING, waivers=waivers)
    assert result.exit_code == 2
    assert message in result.output


def test_problem_of_a_compared_spec_is_reported_with_its_place() -> None:
    result = run(("safety: motion", "safety: moton"))
    assert result.exit_code == 2
    assert "new.yaml:96:17: unknown-word: " in result.output


def test_diff_with_an_unknown_source_exits_with_2() -> None:
    result = CliRunner().invoke(main, ["diff", "old.yaml", "nowhere"])
    assert result.exit_code == 2
    assert "Error: nowhere is not a file, a folder or a git revision" in result.output


def test_diff_lists_rules_and_help_names_the_exit_codes() -> None:
    listed = CliRunner().invoke(main, ["diff", "--rules"])
    assert listed.exit_code == 0
    assert "  id-changed: the id changed from OLD to NEW: requests reach another" in listed.output
    assert "Exit codes: 0 no finding fails;" in CliRunner().invoke(main, ["diff", "--help"]).output


def test_diff_uses_colour_only_on_terminals() -> None:
    assert "\x1b[" not in run(BREAKING).output
    coloured = CliRunner().invoke(main, ["diff", "old.yaml", "new.yaml"], color=True)
    assert "\x1b[31m\x1b[1mwire (1)" in coloured.output
