"""Show a recording: move to any time, play it, explain its entries, export a part of it."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest

from cobotwire.capture import read
from cobotwire.inspect.captured import CapturedMessage, messages
from cobotwire.protocol.errors import CaptureError, CobotwireError, UsageError
from cobotwire.studio.recorded import RecordedSession
from cobotwire.studio.serving import Options, staged
from studio.feeds import Feed, watching
from studio.recordings import TARGET, record
from studio.studio_server import Studio, running


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return record(tmp_path_factory.mktemp("recordings") / "arm.pcapng")


@pytest.fixture(scope="module")
def captured(path: Path) -> list[CapturedMessage]:
    """Return what the recording holds, as the library reads it."""
    return list(messages(read(path)))


@pytest.fixture(scope="module")
def studio(path: Path) -> Iterator[Studio]:
    with running(str(path)) as server:
        yield server


@pytest.fixture
def feed(studio: Studio) -> Iterator[Feed]:
    with watching(studio) as found:
        found.until(lambda: "player" in found.states)
        yield found


def _joints(feed: Feed) -> list[float]:
    found: list[list[float]] = [sample["j"] for sample in feed.samples if "j" in sample]
    return found[-1]


def test_every_message_of_the_recording_is_played_once(
    feed: Feed, captured: list[CapturedMessage]
) -> None:
    feed.wish("play", value=200)
    feed.until(
        lambda: feed.states["player"]["position"] == feed.states["hello"]["recording"]["seconds"]
    )
    feed.until(lambda: not feed.states["player"]["playing"])
    assert [entry["n"] for entry in feed.entries] == list(range(len(captured)))
    assert [entry["d"] for entry in feed.entries] == [each.direction for each in captured]
    assert {entry["k"] for entry in feed.entries} == {"frame"}
    assert feed.states["lost"] == 0
    assert all(abs(a - b) < 0.1 for a, b in zip(_joints(feed), TARGET))


def test_seek_shows_the_entries_before_the_chosen_time(
    feed: Feed, captured: list[CapturedMessage]
) -> None:
    start = captured[0].time_ns
    for seconds in (3.0, 0.5, 5.5):
        feed.wish("seek", value=seconds)
        while feed.states["player"]["position"] != seconds:
            feed.take()
        before = [each for each in captured if each.time_ns - start <= seconds * 1e9]
        assert feed.entries[-1]["n"] == len(before) - 1
        replies: list[Any] = [m.message for m in before if hasattr(m.message, "angles")]
        assert _joints(feed) == [round(angle, 3) for angle in replies[-1].angles]


def test_paused_recording_keeps_its_time_and_a_wrong_speed_is_refused(feed: Feed) -> None:
    feed.wish("seek", value=1.0)
    feed.wish("play", value=0.05)
    feed.until(lambda: feed.states["player"]["playing"])
    feed.wish("pause")
    feed.until(lambda: not feed.states["player"]["playing"])
    assert 1.0 <= feed.states["player"]["position"] < 2.0
    feed.wish("play", value=1e9)
    assert "speed is" in feed.state("refused")


def test_entry_of_a_recording_is_explained(studio: Studio) -> None:
    explained = studio.get("/api/entry/0").json
    assert explained["command"]["name"] == "send_angles"
    assert explained["command"]["place"].startswith("spec/commands/motion.yaml:")
    parts = {part["name"]: part for part in explained["parts"]}
    assert (parts["angles.j1"]["raw"], parts["angles.j1"]["meaning"]) == ("8000", "80 degrees")
    assert " ".join(part["hex"] for part in explained["parts"]) == explained["hex"]
    assert studio.get("/api/entry/100000").status == 404


def test_nothing_is_sent_to_a_recording(studio: Studio, feed: Feed) -> None:
    page = feed.states["hello"]["page"]
    assert studio.post("/api/control", {"take": True}, page).status == 403
    body = {"command": "get_angles", "arguments": {}}
    assert studio.post("/api/send", body, page).status == 403
    assert studio.post("/api/stop", {}).status == 403


def test_exported_recording_holds_the_same_packets(
    studio: Studio, path: Path, tmp_path: Path
) -> None:
    answer = studio.get("/api/export?format=pcapng")
    assert 'filename="studio.pcapng"' in answer.headers["content-disposition"]
    (tmp_path / "again.pcapng").write_bytes(answer.body)
    again, first = read(tmp_path / "again.pcapng"), read(path)
    assert [packet._replace(pieces=()) for packet in again] == [
        packet._replace(pieces=()) for packet in first
    ]
    assert again.interfaces[0].edition == "mycobot280"
    assert again.finished


def test_selection_is_exported_as_tables(studio: Studio, captured: list[CapturedMessage]) -> None:
    query = "format=parquet&command=get_angles&direction=received&begin=1&end=2"
    table = pq.read_table(io.BytesIO(studio.get(f"/api/export?{query}").body))
    start = captured[0].time_ns
    inside = [
        each
        for each in captured
        if hasattr(each.message, "angles")
        and each.direction == "received"
        and 1e9 <= each.time_ns - start < 2e9
    ]
    assert table.num_rows == len(inside) > 10
    packed = zipfile.ZipFile(io.BytesIO(studio.get("/api/export?format=csv").body))
    assert "get_coords.reply.csv" in packed.namelist()


@pytest.mark.parametrize(
    "query", ["format=exe", "direction=up", "begin=soon"], ids=["format", "direction", "time"]
)
def test_wrong_selection_is_refused(studio: Studio, query: str) -> None:
    answer = studio.get(f"/api/export?{query}")
    assert (answer.status, " is " in answer.json["error"]) == (400, True)


@pytest.mark.parametrize(
    ("data", "error", "sentence"),
    [
        (None, UsageError, "no such file"),
        (b"not a recording at all, but some text", CaptureError, "is not a pcapng"),
        (b"", UsageError, "is empty"),
    ],
    ids=["missing", "text", "empty"],
)
def test_file_that_is_not_a_recording_is_rejected_with_the_reason(
    tmp_path: Path, data: bytes | None, error: type[CobotwireError], sentence: str
) -> None:
    path = tmp_path / "arm.pcapng"
    if data is not None:
        path.write_bytes(data)
    with pytest.raises(error, match=sentence), staged(Options(str(path), "mycobot280")):
        pass


def test_recording_that_was_cut_is_shown_as_far_as_it_goes(path: Path, tmp_path: Path) -> None:
    cut = tmp_path / "cut.pcapng"
    cut.write_bytes(path.read_bytes()[:10_001])
    session = RecordedSession(str(cut), "mycobot280")
    assert 50 < len(session.entries()) < 200
    assert "ends in the middle of a packet" in session.remarks[0]
