"""A recording is decoded with the edition that it names, or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from capture.export.exporting import polled, recording
from cobotwire import capture, editions
from cobotwire.cli.app import app
from cobotwire.inspect.captured import messages
from cobotwire.inspect.recorded_edition import codec_of_recording
from cobotwire.protocol.errors import UsageError
from in_process import run

UNKNOWN = "the recording names the edition 'mycobot999', which is not installed"


def test_installed_edition_is_used_whatever_the_default_is() -> None:
    assert codec_of_recording("mecharm270", "mycobot").table.edition == "mecharm270"
    assert codec_of_recording("", "mycobot").table.edition == "mycobot"


@pytest.mark.parametrize("subcommand", ["decode", "replay", "export"])
def test_recording_of_an_edition_that_is_not_installed_is_refused(
    tmp_path: Path, subcommand: str
) -> None:
    path = recording(tmp_path / "arm.pcapng", polled(2), "mycobot999")
    options = ["-o", str(tmp_path / "out")] if subcommand == "export" else []
    ended = run(app, "cobotwire", subcommand, str(path), *options)
    assert ended.returncode == 2
    assert UNKNOWN in ended.stderr
    assert "frame" not in ended.stdout
    assert not list(tmp_path.rglob("*.parquet"))


def test_messages_of_an_edition_that_is_not_installed_are_not_read(tmp_path: Path) -> None:
    path = recording(tmp_path / "arm.pcapng", polled(2), "mycobot999")
    with capture.read(path) as read, pytest.raises(UsageError, match=UNKNOWN):
        list(messages(read))


def test_package_of_your_own_decodes_recordings_that_name_its_edition(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(editions, "names", lambda: ["mycobot"])
    codec_of_recording.cache_clear()
    own = codec_of_recording("mecharm270", "cobotwire.editions.mecharm270")
    assert own.table.edition == "mecharm270"
    with pytest.raises(UsageError, match="--edition PACKAGE"):
        codec_of_recording("mecharm270", "mycobot")
    codec_of_recording.cache_clear()


def test_file_in_place_of_a_package_has_to_be_built(tmp_path: Path) -> None:
    (tmp_path / "pump.yaml").touch()
    with pytest.raises(UsageError, match="is a file: generate a package from it"):
        editions.load(str(tmp_path / "pump.yaml"))


def test_name_in_a_recording_is_never_imported(tmp_path: Path) -> None:
    (tmp_path / "evil").mkdir()
    (tmp_path / "evil" / "__init__.py").write_text("raise SystemExit('imported')")
    for name in (str(tmp_path / "evil"), "this", "\x1b[2J"):
        with pytest.raises(UsageError, match="not installed") as raised:
            codec_of_recording(name, "mycobot")
        assert str(raised.value).isprintable()
