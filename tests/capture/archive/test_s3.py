"""Archives in an object store: a server that speaks the protocol of S3."""

from __future__ import annotations

from pathlib import Path

import pytest
import s3fs

from capture.archive.captures import archive_in, counts, on_one_machine, plan, rows
from cobotwire.capture import archive
from cobotwire.capture.export import Inputs
from cobotwire.inspect.exporting import InstalledEditions
from cobotwire.protocol.errors import OutputError, UsageError


def test_archive_in_an_object_store_is_read_and_written_there(bucket: str, tmp_path: Path) -> None:
    store = s3fs.S3FileSystem()
    (tmp_path / "day").mkdir()
    local = archive_in(tmp_path / "day")
    store.put(str(tmp_path / "day"), f"{bucket}/threads/raw/", recursive=True)
    inputs = Inputs.find([f"{bucket}/threads/raw"])
    one = on_one_machine(tmp_path / "one", local)
    out = f"{bucket}/threads/out"
    many = archive.export(plan(out), inputs, piece_bytes=12_000)
    assert counts(many) == counts(one)
    store.invalidate_cache()
    names = store.find(out)
    assert sorted(f"s3://{name}" for name in names) == sorted(file.path for file in many.files)
    store.get(f"{out}/", str(tmp_path / "many"), recursive=True)
    found, expected = rows(tmp_path / "many"), rows(tmp_path / "one")
    assert found.keys() == expected.keys()
    for message, table in found.items():
        # The inputs have other names there.
        assert table.drop_columns("source") == expected[message].drop_columns("source")
    with pytest.raises(UsageError, match="already holds"):
        archive.export(plan(out), inputs)


def test_bucket_that_does_not_exist_is_an_error(bucket: str, tmp_path: Path) -> None:
    inputs = archive_in(tmp_path)
    with pytest.raises(OutputError, match="there is no bucket no-such-bucket"):
        archive.export(plan("s3://no-such-bucket/out"), inputs)


def test_table_from_a_bucket_equals_table_from_files(bucket: str, tmp_path: Path) -> None:
    archive_in(tmp_path)
    s3fs.S3FileSystem().put(str(tmp_path / "arm1.bin"), f"{bucket}/scanned/arm1.bin")
    files = archive.scan(
        str(tmp_path / "arm1.bin"), InstalledEditions(), "get_angles", piece_bytes=5000
    )
    objects = archive.scan(
        f"{bucket}/scanned/*.bin", InstalledEditions(), "get_angles", piece_bytes=5000
    )
    assert len(objects.pieces) == len(files.pieces) > 10
    expected = files.to_arrow().drop_columns("source")
    assert objects.to_arrow().drop_columns("source") == expected
