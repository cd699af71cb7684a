"""Run the page "From captures to answers": its commands, its queries and its pictures."""

from __future__ import annotations

import re
import runpy
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import polars as pl
import pyarrow as pa
import pytest

from docs.pages import BLOCK, run
from vectors import ROOT

PAGE = ROOT / "docs" / "answers.md"
PICTURES = ("answers-temperatures.svg", "answers-reply-times.svg")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder in which the commands of the page have been run."""
    folder = tmp_path_factory.mktemp("answers")
    shutil.copytree(ROOT / "docs" / "answers", folder / "docs" / "answers")
    runs = list(run(PAGE, folder, ""))
    assert len(runs) == 3
    assert [each for each in runs if not each.matches] == []
    return folder


def sections() -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """Yield the title of each section, and the kind and text of its blocks."""
    for section in PAGE.read_text(encoding="utf-8").split("\n## ")[1:]:
        title = section.partition("\n")[0]
        yield title, [(block["kind"], block["text"]) for block in BLOCK.finditer(section)]


def rows(answer: Any) -> list[dict[str, Any]]:
    """Return the rows of an answer of any of the libraries; times in microseconds."""
    table = pl.DataFrame(pa.table(answer)).select(pl.exclude("^__index.*$"))  # pandas has an index
    table = table.with_columns(pl.selectors.datetime().dt.cast_time_unit("us"))
    if "day" in table.columns:
        table = table.with_columns(pl.col("day").cast(pl.Date))
    return table.select(sorted(table.columns)).to_dicts()


def test_libraries_give_the_answers_of_the_page(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    names: dict[str, Any] = {}
    answered = 0
    for title, blocks in sections():
        answers = []
        for kind, text in blocks:
            if kind == "python":
                names.pop("answer", None)
                exec(compile(text, f"{PAGE} {title}", "exec"), names)
                answers += [rows(names["answer"])] if "answer" in names else []
            elif kind == "text":
                assert capsys.readouterr().out.strip() == text.strip()
        assert answers == answers[:1] * len(answers), title
        answered += len(answers)
    assert answered == 9, "three questions in three libraries"
    hottest = names["hottest"]
    assert (hottest["j2"].max(), len(hottest)) == (51, 864)


def test_pictures_of_the_page_are_those_of_the_capture(folder: Path) -> None:
    program = runpy.run_path(str(ROOT / "docs" / "answers" / "draw.py"))
    program["main"](folder / "archive", folder)
    page = PAGE.read_text(encoding="utf-8")
    for name in PICTURES:
        assert f"](plots/{name})" in page
        # Coordinates depend on the version of matplotlib; the words do not.
        drawn, committed = [
            re.findall(r"<!-- (.*?) -->|<text[^>]*>([^<]*)<", (place / name).read_text())
            for place in (folder, ROOT / "docs" / "plots")
        ]
        assert drawn == committed
        assert (folder / name).stat().st_size < 60_000
