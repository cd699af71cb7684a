"""Run the guide's pages and the README on a simulated arm."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import PtyServer, SimulatedArm
from docs.pages import run
from vectors import ROOT

GUIDE = ROOT / "docs" / "guide"
# The page programs.md includes files; tests/examples runs them. The README is a page too.
PAGES = [
    ROOT / "README.md",
    ROOT / "docs" / "start.md",
    ROOT / "docs" / "motion.md",
    *sorted({*GUIDE.glob("*.md")} - {GUIDE / "programs.md"}),
]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_of_guide_page_print_the_output_of_the_page(page: Path, tmp_path: Path) -> None:
    shutil.copytree(ROOT / "spec", tmp_path / "spec")
    with PtyServer(SimulatedArm(TABLE)) as server:
        runs = list(run(page, tmp_path, server.url))
    assert runs, "each page of the guide has at least one command"
    assert [each for each in runs if not each.matches] == []


def test_command_with_other_output_than_the_page_does_not_match(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(
        "```console\n$ echo one; echo two\none\n```\n```console\n$ echo a\n...\na\n```\n"
    )
    assert [each.matches for each in run(page, tmp_path, "")] == [False, True]


def test_finding_of_a_slow_machine_does_not_count_as_a_difference_from_the_page(
    tmp_path: Path,
) -> None:
    slow = "- slow: a round trip takes 16.0 ms\n    if this is a USB adapter, its timer\n"
    (tmp_path / "printed.txt").write_text(f"! no-power: the arm\n    advice\n{slow}")
    page = tmp_path / "page.md"
    page.write_text("```console\n$ cat printed.txt\n! no-power: the arm\n    advice\n```\n")
    assert [each.matches for each in run(page, tmp_path, "")] == [True]
