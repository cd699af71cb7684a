"""The comparison of two revisions runs both, and calls a row faster only if most rounds agree."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from rich.console import Console

import compare
import compare_builds
from compare import Compared
from speed_rows import Streams

ROUNDS = 2


@pytest.mark.parametrize(
    ("theirs", "verdict"),
    [
        ([1.05, 1.06, 1.05, 1.07, 1.04], "faster"),
        ([0.95, 0.94, 0.96, 0.95, 0.93], "slower"),
        ([0.99, 1.01, 1.02, 0.98, 1.0], "the same"),
        ([1.011, 1.012, 1.013, 1.014, 1.015], "the same"),  # the memory of the processes differs
        ([1.05, 1.06, 0.7, 1.07, 1.04], "faster"),  # one disturbed round
    ],
)
def test_row_differs_only_if_the_middle_half_of_its_rounds_agrees(
    theirs: list[float], verdict: str
) -> None:
    assert Compared("row", [1.0] * 5, theirs).verdict == verdict


def test_two_trees_run_the_same_rows_in_one_comparison(tmp_path: Path) -> None:
    Streams.write(tmp_path, 0.1, 500)
    trees = (compare_builds.ROOT, compare_builds.ROOT)
    rows = ["memcpy", "noisy scan", "reused", "list", "encode", "blocking call", "asyncio call"]
    found = list(compare.compare(trees, tmp_path, rows, ROUNDS))
    assert [each.row for each in found] == rows
    for each in found:
        assert len(each.ours) == len(each.theirs) == ROUNDS
        assert all(spent > 0 for spent in (*each.ours, *each.theirs))
    text = io.StringIO()
    compare.show("a tree against itself", iter(found), Console(file=text, width=100))
    assert all(row in text.getvalue() for row in rows)


def test_row_that_a_tree_lacks_is_reported_as_such(tmp_path: Path) -> None:
    text = io.StringIO()
    console = Console(file=text, width=100)
    compare.show("against an older one", iter([Compared("scan", [], [])]), console)
    assert "a tree cannot run it" in text.getvalue()


def test_unknown_revision_is_an_error_that_names_it() -> None:
    with pytest.raises(compare_builds.NoBuildError, match="no-such-revision"):
        compare_builds.extracted("no-such-revision")


def test_revision_is_extracted_once_with_its_files_and_links(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compare_builds, "PLACE", tmp_path)
    tree = compare_builds.extracted("HEAD")
    assert (tree / "rust" / "core" / "src" / "scan.rs").read_text()
    assert (tree / "python" / "cobotwire" / "spec").is_symlink()
    assert compare_builds.extracted("HEAD") == tree
