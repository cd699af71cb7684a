"""The resync report distinguishes good readers from bad ones, and counts every loss."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

import readers
import resync
from cobotwire.editions.mycobot280 import TABLE
from damage import damage
from readers import Accepted
from scoring import Verdict, score
from streams import Line, catalogue

NO_LOSS = "lost that no legal false frame covers: 0"


def _line(kind: str = "false header") -> Line:
    return damage(TABLE, catalogue(TABLE, 4000, "reply"), kind, 1e-2)


def _verdict_on(line: Line, read: Sequence[Accepted]) -> Verdict:
    return score(TABLE, "reply", line, read)


def test_every_frame_that_the_codec_loses_is_explained_by_the_table() -> None:
    line = _line()
    verdict = _verdict_on(line, readers.ours(TABLE, "native", "reply")(line.data))
    assert verdict.covered
    assert verdict.unexplained == []
    assert verdict.recovered + len(verdict.covered) == verdict.undamaged


@pytest.mark.parametrize("reader", [readers.textbook(TABLE), readers.pymycobot()])
def test_reader_that_consumes_on_failure_loses_unexplained_frames(reader: readers.Reader) -> None:
    line = _line()
    verdict = _verdict_on(line, reader(line.data))
    assert len(verdict.unexplained) > len(verdict.covered)


def test_perfect_reader_has_no_loss_and_a_missing_frame_is_unexplained() -> None:
    line = _line("mixed")
    whole = [
        Accepted(start, end, line.data[start:end])
        for start, end, ok in zip(line.starts.tolist(), line.ends.tolist(), line.whole.tolist())
        if ok
    ]
    verdict = _verdict_on(line, whole)
    assert (verdict.share, verdict.phantoms, verdict.altered) == (1.0, 0, 0)
    missing = _verdict_on(line, whole[:100] + whole[101:])
    assert missing.unexplained == [whole[100].start]


def test_wrong_frame_is_counted_as_altered_or_as_phantom() -> None:
    frame = bytes.fromhex("FE FE 03 12 01 FA")
    clean = catalogue(TABLE, 4000, "reply")
    line = damage(TABLE, clean, "flip", 1e-2)
    read = readers.ours(TABLE, "native", "reply")(line.data)
    verdict = _verdict_on(line, read)
    assert verdict.altered > 0
    nowhere = Accepted(len(line.data), len(line.data) + len(frame), frame)
    assert _verdict_on(line, [*read, nowhere]).phantoms == verdict.phantoms + 1


def test_pymycobots_reader_reads_a_clean_line_completely() -> None:
    line = catalogue(TABLE, 500, "reply")
    found = readers.pymycobot()(line.data)
    assert [frame.data for frame in found] == [line.original(i) for i in range(line.frames)]


def test_pymycobot_drops_a_reply_after_an_ack() -> None:
    line = _line("ack")
    verdict = _verdict_on(line, readers.pymycobot_by_request(line))
    assert verdict.undamaged - verdict.recovered == len(line.acks) > 0


@pytest.fixture
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    few = [resync.Scenario("mycobot280", "catalogue", "reply", "false header", 1e-2)]
    monkeypatch.setattr(resync, "scenarios", lambda: few)
    monkeypatch.setattr("sys.argv", ["resync.py", "--frames", "2000"])


@pytest.mark.usefixtures("short")
def test_report_exits_with_1_if_a_lost_frame_is_unexplained(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert resync.main() == 0
    assert NO_LOSS in capsys.readouterr().out
    monkeypatch.setattr(readers, "ours", lambda table, name, listening: readers.textbook(table))
    assert resync.main() == 1
    assert NO_LOSS not in capsys.readouterr().out


@pytest.mark.usefixtures("short")
def test_report_exits_with_1_if_the_codecs_differ(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    ours = readers.ours
    monkeypatch.setattr(
        readers,
        "ours",
        lambda table, name, listening: (
            ours(table, name, listening) if name == "native" else readers.textbook(table)
        ),
    )
    assert resync.main() == 1
    out = capsys.readouterr().out
    assert NO_LOSS in out
    assert "THE CODECS DIFFER" in out
