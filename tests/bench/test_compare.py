"""The comparison of two revisions runs both, and calls a row faster only if most rounds agree."""

from __future__ import annotations

import pytest

import compare
from compare import Compared


@pytest.mark.parametrize(
    ("theirs", "verdict"),
    [
        ([1.05, 1.06, 1.05, 1.07, 1.04], "faster"),
        ([0.95, 0.94, 0.96, 0.95, 0.93], "slower"),
        ([0.99, 1.01, 1.02, 0.98, 1.0], "the same"),
        ([1.011, 1.012, 1.013, 1.014, 1.015], "the same"),  # as much as memory layout changes
        ([1.05, 1.06, 0.7, 1.07, 1.04], "faster"),  # one disturbed round
    ],
)
def test_row_differs_only_if_the_middle_half_of_its_ratios_excludes_one(
    theirs: list[float], verdict: str
) -> None:
    assert Compared("row", [1.0] * 5, theirs).verdict == verdict


def test_two_source_trees_run_the_same_rows_in_one_comparison() -> None:
    words = ["--megabytes", "0.1", "--frames", "500", "--rows", "memcpy in two|encode"]
    found = list(compare.compare((compare.ROOT, compare.ROOT), 2, words))
    names = ["memcpy in two threads", "encode send_angles", "encode send_angles"]
    assert [each.row[3:] for each in found] == names
    for each in found:
        assert len(each.ours) == len(each.theirs) == 2
        assert all(spent > 0 for spent in (*each.ours, *each.theirs))
        assert each.verdict in str(each)


def test_unknown_revision_is_an_error_that_names_it(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.argv", ["compare.py", "no-such-revision"])
    with pytest.raises(SystemExit, match="no-such-revision"):
        compare.main()
    assert "Needed a single revision" in capfd.readouterr().err
