"""Cut, merge and repair recordings of cobotwire, of other programs, and damaged ones."""

from __future__ import annotations

import re
import shutil
import struct
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from capture.export.exporting import polled, recording, reply
from capture.foreign_files import Writer, damaged_files, files
from capture.lines import packets, reader, written
from cobotwire.capture import Packet, read
from cobotwire.capture import block_encoding as blocks
from cobotwire.capture.editing import by_command, cut, merge, repair
from cobotwire.capture.overview import overview
from cobotwire.inspect.captured import recorded_codecs
from cobotwire.protocol.errors import CaptureError, UsageError

OWN = st.lists(packets(), max_size=5).map(lambda made: sorted(made, key=lambda it: it.time_ns))
DAMAGE = (CaptureError, UsageError)


@contextmanager
def stored(*contents: bytes) -> Iterator[list[Path]]:
    """Yield files with these contents, and the name of a file that does not exist."""
    with tempfile.TemporaryDirectory() as folder:
        names = [Path(folder, f"{number}.pcapng") for number in range(len(contents))]
        for name, content in zip(names, contents):
            name.write_bytes(content)
        yield [*names, Path(folder, "out.pcapng")]
        assert all(name.read_bytes() == content for name, content in zip(names, contents))
        assert {*Path(folder).iterdir()} <= {*names, Path(folder, "out.pcapng")}


@settings(max_examples=20)
@given(files, st.data())
def test_cut_keeps_exactly_the_packets_in_the_range(whole: bytes, data: st.DataObject) -> None:
    every = reader(whole)
    made = list(every)
    times = st.sampled_from([packet.time_ns + n for packet in made for n in (0, 1)] or [0])
    begin, end = sorted((data.draw(times), data.draw(times) + 1))
    end += begin == end
    expected = [packet for packet in made if begin <= packet.time_ns < end]
    with stored(whole) as (source, out):
        counts, _ = cut(source, out, begin, end)
        assert counts["kept"] == len(expected)
        kept = read(out)
        assert list(kept) == expected
        assert (kept.interfaces, kept.finished) == (every.interfaces, every.finished)


@settings(max_examples=20)
@given(OWN, st.data())
def test_merged_parts_of_a_recording_have_its_packets(
    made: list[Packet], data: st.DataObject
) -> None:
    at = data.draw(st.sampled_from([packet.time_ns for packet in made] or [0]))
    with stored(written(made)) as (source, out):
        first, second = source.with_name("first"), source.with_name("second")
        cut(source, first, end_ns=at)
        cut(source, second, begin_ns=at)
        found, _ = merge([second, first], out)
        merged = read(out)
        assert [packet._replace(interface=0) for packet in merged] == made
        assert merged.finished
        assert [each.interface for each in found] == merged.interfaces
        assert sum(each.packets for each in found) == len(made)
        first.unlink()
        second.unlink()


@settings(max_examples=20)
@given(OWN, st.data())
def test_repair_of_any_prefix_keeps_the_whole_packets(
    made: list[Packet], data: st.DataObject
) -> None:
    whole = written(made)
    start = len(written([], finish=False))
    size = data.draw(st.integers(start, len(whole)))
    expected = list(reader(whole[:size]))
    with stored(whole[:size]) as (source, out):
        done = repair(source, out)
        again = read(out)
        assert list(again) == expected
        assert again.finished
        assert done.packets == len(expected)
        # Lost and kept bytes add up to the whole file.
        lost = sum(end - begin for begin, end, _ in done.losses)
        assert whole[: size - lost] == out.read_bytes()[: size - lost]
        assert (size < len(whole)) == bool(done.lost_ranges or done.marked)


@settings(max_examples=25)
@given(damaged_files())
def test_repaired_file_is_whole_and_keeps_what_can_be_read(damaged: bytes) -> None:
    before: list[Packet] = []
    with suppress(CaptureError):
        before.extend(reader(damaged))
    with stored(damaged) as (source, out):
        try:
            repair(source, out)
        except CaptureError:
            assert not before
            return
        after: list[Packet] = []
        # The link type may be damaged, for example.
        with suppress(CaptureError):
            after.extend(read(out))
        assert after[: len(before)] == before
        again = repair(out, out.with_name("0.pcapng"), overwrite=True)
        assert (again.lost_ranges, again.marked) == (0, 0)
        assert source.read_bytes() == out.read_bytes()
        source.write_bytes(damaged)


@settings(max_examples=25)
@given(st.one_of(damaged_files(), st.binary(max_size=60)))
def test_arbitrary_bytes_are_an_error_that_leaves_no_file(data: bytes) -> None:
    with stored(data) as (source, out):
        for action in (lambda: cut(source, out, end_ns=1), lambda: merge([source, source], out)):
            try:
                action()
            except DAMAGE:
                assert not out.exists()
            out.unlink(missing_ok=True)
        # The edited file may name an unknown edition.
        with suppress(UsageError):
            assert overview(source, recorded_codecs()).size <= len(data)


def test_everything_between_two_damaged_places_is_kept(tmp_path: Path) -> None:
    whole = written([Packet(n, "sent", bytes([n]) * 9) for n in range(9)])
    ends = [len(written([Packet(0, "sent", bytes(9))] * n, finish=False)) for n in range(10)]
    # The length of a packet reaches beyond the end of the file, and the data of another changes.
    broken = bytearray(whole)
    broken[ends[2] + 4 : ends[2] + 8] = struct.pack("<I", 1 << 20)
    broken[ends[6] + 20 : ends[6] + 24] = struct.pack("<I", 99)
    source, out = tmp_path / "broken.pcapng", tmp_path / "out.pcapng"
    source.write_bytes(broken)
    done = repair(source, out)
    assert [packet.time_ns for packet in read(out)] == [0, 1, 3, 4, 5, 7, 8]
    assert [loss[:2] for loss in done.losses] == [(ends[2], ends[3]), (ends[6], ends[7])]
    assert (done.marked, done.lost_bytes) == (0, 2 * (ends[1] - ends[0]))


@pytest.mark.parametrize("lost", ["section", "interface"])
def test_packets_of_a_lost_description_are_lost(tmp_path: Path, lost: str) -> None:
    # Otherwise they would belong to another port.
    first = written([Packet(1, "sent", b"x")], "/dev/a")
    second = written([Packet(2, "sent", b"y")], "/dev/b", "/dev/c")
    place = 0 if lost == "section" else second.index(b"/dev/b") - 20
    broken = second[: place + 4] + b"\xff" + second[place + 5 :]
    (tmp_path / "broken.pcapng").write_bytes(first + broken + first)
    repair(tmp_path / "broken.pcapng", tmp_path / "out.pcapng")
    again = read(tmp_path / "out.pcapng")
    assert [packet.data for packet in again] == [b"x", b"x"]
    assert [each.url for each in again.interfaces] == ["/dev/a", "/dev/a"]


def test_unknown_blocks_and_comments_are_kept_byte_for_byte(tmp_path: Path) -> None:
    writer = Writer("<")
    note = writer.options([(1, b"a note")], end=True)
    section, stated = (
        writer.block(blocks.SECTION, writer.pack("IHHq", blocks.BYTE_ORDER_MAGIC, 1, 0, n) + note)
        for n in (-1, 999)
    )
    strange = writer.block(4, b"names") + writer.block(0x0BAD, b"\x01\x02\x03\x04private")
    whole = section + written([Packet(5, "sent", b"x")])[len(blocks.section("cobotwire")) :]
    source, out = tmp_path / "in.pcapng", tmp_path / "out.pcapng"
    # Editing removes only the stated length of the section.
    source.write_bytes(stated + (whole + strange)[len(section) :])
    cut(source, out, end_ns=9)
    assert out.read_bytes() == whole + strange
    repair(source, out, overwrite=True)
    assert out.read_bytes() == whole + strange
    merge([source, source], out, overwrite=True)
    assert out.read_bytes().count(strange) == 2
    assert out.read_bytes().count(b"a note") == 2


def test_recordings_that_one_section_cannot_hold_are_rejected(tmp_path: Path) -> None:
    own = written([])
    writer = Writer(">")
    head = writer.pack("IHHq", blocks.BYTE_ORDER_MAGIC, 1, 0, -1)
    for content, why in ((own + own, "second section"), (writer.block(10 << 24, b""), "pcapng")):
        (tmp_path / "in.pcapng").write_bytes(content)
        with pytest.raises(DAMAGE, match=why):
            merge([tmp_path / "in.pcapng"], tmp_path / "out.pcapng")
    (tmp_path / "in.pcapng").write_bytes(writer.block(blocks.SECTION, head))
    with pytest.raises(UsageError, match="big-endian"):
        merge([tmp_path / "in.pcapng"], tmp_path / "out.pcapng")
    assert not (tmp_path / "out.pcapng").exists()


@pytest.mark.parametrize(
    ("commands", "not_commands", "noise", "kept"),
    [
        (["get_angles"], [], False, 7),
        (["is_power_on"], [], True, 2),
        ([], ["get_angles"], False, 1),
        ([], [], False, 7),
    ],
)
def test_commands_choose_requests_and_replies(
    tmp_path: Path, commands: list[str], not_commands: list[str], noise: bool, kept: int
) -> None:
    powered = Packet(2, "received", polled(1)[1].data + reply("is_power_on", 1), "bytes")
    made = [*polled(3), powered, Packet(3, "received", b"Guru", "noise", "no-header")]
    source = recording(tmp_path / "in.pcapng", made)
    choose = by_command(recorded_codecs(), commands, not_commands, noise)
    counts, _ = cut(source, tmp_path / "out.pcapng", choose=choose)
    assert counts["kept"] == kept
    assert counts["noise"] == (not noise)
    assert len(list(read(tmp_path / "out.pcapng"))) == kept


def test_chunks_cannot_be_cut_by_command(tmp_path: Path) -> None:
    source = recording(tmp_path / "in.pcapng", [Packet(1, "received", b"\xfe\xfe\x02", "bytes")])
    with pytest.raises(UsageError, match="FE FE 02 does not consist of whole frames"):
        cut(source, tmp_path / "out.pcapng", choose=by_command(recorded_codecs(), [], ["x"], False))


def test_interrupted_or_refused_cut_leaves_no_file(tmp_path: Path) -> None:
    source = recording(tmp_path / "in.pcapng", polled(3))

    def interrupt(size: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        cut(source, tmp_path / "out.pcapng", progress=interrupt)
    with pytest.raises(UsageError, match="also an input"):
        cut(source, source, overwrite=True)
    (tmp_path / "out.pcapng").write_bytes(b"mine")
    with pytest.raises(UsageError, match="--overwrite"):
        cut(source, tmp_path / "out.pcapng")
    assert (tmp_path / "out.pcapng").read_bytes() == b"mine"
    assert len([*tmp_path.iterdir()]) == 2


@pytest.mark.skipif(not shutil.which("capinfos"), reason="Wireshark is not installed")
def test_wireshark_reads_what_is_cut_merged_and_repaired(tmp_path: Path) -> None:
    source, out = recording(tmp_path / "in.pcapng", polled(50)), tmp_path / "cut.pcapng"
    cut(source, out, begin_ns=polled(11)[-2].time_ns)
    merge([source, out], tmp_path / "merged.pcapng")
    broken = bytearray(source.read_bytes()[:-150])
    broken[2000:2050] = bytes(50)
    (tmp_path / "broken.pcapng").write_bytes(broken)
    kept = repair(tmp_path / "broken.pcapng", tmp_path / "repaired.pcapng").packets
    names = "cut.pcapng", "merged.pcapng", "repaired.pcapng"
    words = ["capinfos", "-c", *(str(tmp_path / name) for name in names)]
    shown = subprocess.run(words, capture_output=True, text=True, check=True)
    assert [*map(int, re.findall(r"packets: +(\d+)", shown.stdout))] == [80, 180, kept]
    assert 0 < kept < 99
