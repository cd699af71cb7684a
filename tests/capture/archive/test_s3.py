"""Archives in an object store: a server that speaks the protocol of S3."""

from __future__ import annotations

from pathlib import Path

import pytest
import s3fs

from capture.archive.captures import archive_in, counts, on_one_machine, plan, rows
from cobotwire.capture import archive
from cobotwire.capture.archive import Engine, ThreadEngine
from cobotwire.capture.export import Inputs
from cobotwire.protocol.errors import OutputError, UsageError


def check_object_store(bucket: str, folder: Path, engine: Engine) -> None:
    """Export an archive from a bucket into it; check that it holds the rows of one machine."""
    store = s3fs.S3FileSystem()
    (folder / "day").mkdir()
    local = archive_in(folder / "day")
    store.put(str(folder / "day"), f"{bucket}/raw/", recursive=True)
    one = on_one_machine(folder / "one", local)
    inputs, out = Inputs.find([f"{bucket}/raw"]), f"{bucket}/out"
    many = archive.export(plan(out), inputs, engine, piece_bytes=12_000)
    assert counts(many) == counts(one)
    store.invalidate_cache()
    names = store.find(out)
    assert sorted(f"s3://{name}" for name in names) == sorted(file.path for file in many.files)
    store.get(f"{out}/", str(folder / "many"), recursive=True)
    found, expected = rows(folder / "many"), rows(folder / "one")
    assert found.keys() == expected.keys()
    for message, table in found.items():
        # The inputs have other names in the object store.
        assert table.drop_columns("source") == expected[message].drop_columns("source")
    with pytest.raises(UsageError, match="already holds"):
        archive.export(plan(out), inputs)


def test_archive_in_an_object_store_is_read_and_written_there(bucket: str, tmp_path: Path) -> None:
    check_object_store(f"{bucket}/threads", tmp_path, ThreadEngine())


def test_bucket_that_does_not_exist_is_an_error(bucket: str, tmp_path: Path) -> None:
    inputs = archive_in(tmp_path)
    with pytest.raises(OutputError, match="there is no bucket no-such-bucket"):
        archive.export(plan("s3://no-such-bucket/out"), inputs)
