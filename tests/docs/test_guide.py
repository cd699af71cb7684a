"""The guide's pages do what they say, on a simulated arm."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cobotwire.editions.mycobot280 import TABLE
from cobotwire.sim import PtyServer, SimulatedArm
from cobotwire.sim.kinematics import prepare
from docs.pages import run
from vectors import ROOT

PAGES = [ROOT / "docs" / "start.md", *sorted((ROOT / "docs" / "guide").glob("*.md"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_page_does_what_it_says(page: Path, tmp_path: Path) -> None:
    shutil.copytree(ROOT / "spec", tmp_path / "spec")
    prepare()
    with PtyServer(SimulatedArm(TABLE)) as server:
        ran = list(run(page, tmp_path, server.url))
    assert ran, "a page of the guide runs something"
    assert [each for each in ran if not each.fits] == []


def test_a_page_that_is_wrong_is_noticed(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(
        "```console\n$ echo one; echo two\none\n```\n```console\n$ echo a\n...\na\n```\n"
    )
    assert [each.fits for each in run(page, tmp_path, "")] == [False, True]
