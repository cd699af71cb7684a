"""Query an archive without Dask: threads make the Arrow tables."""

from __future__ import annotations

from pathlib import Path

import pytest

from capture.archive.captures import archive_in, counts, on_one_machine, rows
from cobotwire.capture import archive
from cobotwire.capture.archive import ThreadEngine
from cobotwire.capture.export import Inputs
from cobotwire.inspect.exporting import InstalledEditions
from cobotwire.protocol.errors import UsageError


@pytest.fixture(scope="module")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> Inputs:
    return archive_in(tmp_path_factory.mktemp("captures"))


def test_tables_hold_the_rows_of_an_export_in_their_order(inputs: Inputs, tmp_path: Path) -> None:
    report = on_one_machine(tmp_path / "one", inputs, wide=True)
    exported = rows(tmp_path / "one")["get_angles.reply"]
    urls = [input.url for input in inputs.files]
    scan = archive.scan(urls, InstalledEditions(), "get_angles", piece_bytes=3001)
    assert len(scan.pieces) > 10
    table = scan.to_arrow(ThreadEngine(3))
    assert table.schema == scan.schema
    assert table.column_names == exported.column_names
    for name in ("offset", "time", "j1", "j6"):
        assert table.column(name).to_pylist() == exported.column(name).to_pylist()
    assert set(table.column("robot").to_pylist()) == {"arm1", "arm2", "arm4", "arm5"}
    scanned = counts(scan.report())
    # A scan selects one message; the others are counted as ``not_chosen``.
    assert scanned.pop("not_chosen") == report.rows.total() - report.rows["get_angles.reply"]
    assert scanned["noise"] == counts(report)["noise"]
    assert (scanned["bytes"], scanned["rejected"]) == (report.bytes, report.rejected)


def test_message_that_no_input_holds_has_an_empty_table(inputs: Inputs) -> None:
    table = archive.scan(inputs.files[0].url, InstalledEditions(), "get_encoders").to_arrow()
    assert table.num_rows == 0
    assert "offset" in table.column_names


def test_message_that_the_edition_lacks_is_rejected(inputs: Inputs) -> None:
    url = inputs.files[0].url
    with pytest.raises(UsageError, match="did you mean get_angles"):
        archive.scan(url, InstalledEditions(), "get_angels")
    with pytest.raises(UsageError, match="jog_stop has no reply"):
        archive.scan(url, InstalledEditions(), "jog_stop")
    with pytest.raises(UsageError, match="no such file"):
        archive.scan(f"{url}.bak", InstalledEditions(), "get_angles")
