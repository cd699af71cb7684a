"""Cut, merge and repair recordings: their blocks are written as they are stored.

All three keep the blocks that cobotwire does not interpret (names, comments, private blocks), and
their memory does not depend on the size of the files. ``output`` is written under a temporary name.
All of them raise UsageError if a file cannot be opened, or ``output`` exists or is an input;
CaptureError if an input is not a recording; OutputError if ``output`` cannot be written.
"""

from __future__ import annotations

import heapq
import io
import os
import struct
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple, cast

from cobotwire.capture import block_encoding as blocks
from cobotwire.capture.block_parsing import Fields
from cobotwire.capture.damage import MOST_INTERFACES, damaged
from cobotwire.capture.export.atomic_file import AtomicFile, output_error, sync_folder
from cobotwire.capture.export.plan import check_range
from cobotwire.capture.packet import Interface, Packet
from cobotwire.capture.packet_parsing import OURS, PacketParser, decoded
from cobotwire.capture.stored_blocks import BlockFile, Progress, StoredBlock, block_file
from cobotwire.capture.streams import LISTENING
from cobotwire.codec.interface import Codec, Frame, Framer, Noise
from cobotwire.protocol.errors import CaptureError, CobotwireError, ProtocolError, UsageError

# Returns "kept", or why a packet of an interface is left out.
Choose = Callable[[Packet, Interface], str]
SourcePath = str | os.PathLike[str]

# Bytes to write at a time.
_WRITE = 1 << 18
# Later than any time stamp; negated, earlier than any.
_ALWAYS = 1 << 200
# At most this many losses are listed; all are counted.
_LISTED = 20


@contextmanager
def _output(
    output: SourcePath, overwrite: bool, sources: Sequence[SourcePath]
) -> Iterator[Callable[[bytes], object]]:
    """Yield a function that writes to a file; an exception keeps it from getting its final name."""
    path = Path(output)
    for source in sources:
        if path.exists() and os.path.samefile(path, source):
            message = f"{path} is also an input, and inputs are not changed; give another name"
            raise UsageError("output", str(path), message=message)
    atomic = AtomicFile(path, overwrite)
    try:
        gathered = io.BufferedWriter(cast("io.RawIOBase", atomic.file), _WRITE)
        yield gathered.write
        gathered.flush()
        atomic.publish()
        sync_folder(path.parent)
    except CobotwireError:
        raise
    except OSError as error:
        raise output_error(path, error) from error
    finally:
        atomic.discard()


def _as_stored(block: StoredBlock) -> bytes:
    """Return a block that is not a packet; a section no longer states its length."""
    if block.kind != blocks.SECTION:
        return block.data
    return block.data[:16] + struct.pack("<q", blocks.SECTION_LENGTH_UNKNOWN) + block.data[24:]


def cut(
    source: SourcePath,
    output: SourcePath,
    begin_ns: int | None = None,
    end_ns: int | None = None,
    choose: Choose | None = None,
    *,
    overwrite: bool = False,
    progress: Progress = lambda size: None,
) -> tuple[Counter[str], str]:
    """Write the packets from ``begin_ns`` on and before ``end_ns`` that ``choose`` keeps.

    Their bytes, times and comments do not change. All other blocks are kept, also the statistics at
    the end, which describe the whole recording.

    Returns:
        The number of packets that are ``kept``, the number that are not, by reason, and what the
        source lacks.

    Raises:
        CaptureError: the source is damaged.
    """
    check_range(begin_ns, end_ns)
    begin = -_ALWAYS if begin_ns is None else begin_ns
    end = _ALWAYS if end_ns is None else end_ns
    kept, outside, others = 0, 0, Counter[str]()
    with block_file(source, progress) as file, _output(output, overwrite, [source]) as write:
        parser = PacketParser(file.name)
        # Reads the interface and the time stamp of a packet, after its kind and length.
        stamps = {order: struct.Struct(order + "III").unpack_from for order in "<>"}
        # The time stamps to keep, for each interface of the section.
        limits: list[tuple[int, int]] = []
        for block in file:
            if block.kind != blocks.PACKET:
                parser.take(block.parsed)
                if block.kind in (blocks.SECTION, blocks.INTERFACE):
                    limits = list(zip(parser.ticks(begin), parser.ticks(end)))
                write(_as_stored(block))
                continue
            try:
                index, high, low = stamps[block.order](block.data, 8)
                first, after = limits[index]
            except (struct.error, IndexError):
                parser.stamp(block.parsed)
                raise
            if not first <= high << 32 | low < after:
                outside += 1
            elif choose and (why := _reason(block, parser, choose)) != "kept":
                others[why] += 1
            else:
                kept += 1
                write(block.data)
        lacks = file.incomplete
    return +Counter({"kept": kept, "outside of the time range": outside} | others), lacks


def _reason(block: StoredBlock, parser: PacketParser, choose: Choose) -> str:
    packet = parser.take(block.parsed)
    assert packet is not None, "the block is a packet"
    return choose(packet, parser.interfaces[packet.interface])


def by_command(
    codec_of: Callable[[Interface], Codec],
    commands: Collection[str],
    not_commands: Collection[str],
    noise: bool,
) -> Choose:
    """Return a chooser of requests and replies of ``commands``, or of all but ``not_commands``.

    ``noise`` is whether noise is kept. A packet with several frames is kept if any of them is
    chosen.
    """
    framers: dict[tuple[int, str], tuple[Codec, Framer]] = {}

    def choose(packet: Packet, interface: Interface) -> str:
        if packet.kind == "noise":
            return "kept" if noise else "noise"
        key = packet.interface, packet.direction
        if key not in framers:
            codec, listening = codec_of(interface), LISTENING.get(packet.direction, "both")
            framers[key] = codec, codec.framer(listening, accept_unknown=True)
        codec, framer = framers[key]
        events = framer.feed(packet.data) + framer.flush()
        if packet.kind == "bytes" and any(isinstance(event, Noise) for event in events):
            message = (
                f"the packet {packet.data[:16].hex(' ').upper()} does not consist of whole frames, "
                "as usual in recordings of other programs: cut this one by time only"
            )
            raise UsageError("commands", packet.data, message=message)
        for event in events:
            names = _names(codec, event) if isinstance(event, Frame) else set()
            if names.isdisjoint(not_commands) and (not commands or names & {*commands}):
                return "kept"
        return "other commands"

    return choose


def _names(codec: Codec, frame: Frame) -> set[str]:
    """Return the command of a frame; all commands with its id if its values are illegal."""
    try:
        return {frame.message.command.name}
    except ProtocolError:
        return {each.name for each in codec.table.commands if each.id == frame.command}


class MergedInterface:
    """An interface of a merged file: its source, and the number and times of its packets."""

    def __init__(self, source: str, interface: Interface) -> None:
        self.source, self.interface = source, interface
        self.packets = self.first_ns = self.last_ns = 0

    def add(self, time_ns: int) -> None:
        """Count a packet."""
        self.first_ns = min(self.first_ns, time_ns) if self.packets else time_ns
        self.last_ns = max(self.last_ns, time_ns) if self.packets else time_ns
        self.packets += 1

    def overlaps(self, other: MergedInterface) -> bool:
        """Return whether both recorded one port at the same time."""
        meet = self.first_ns <= other.last_ns and other.first_ns <= self.last_ns
        both = bool(self.packets and other.packets) and meet
        return both and self.interface.url == other.interface.url != ""


def merge(
    sources: Sequence[SourcePath],
    output: SourcePath,
    *,
    overwrite: bool = False,
    progress: Progress = lambda size: None,
) -> tuple[list[MergedInterface], list[str]]:
    """Write several recordings into one section, by the times of their packets.

    Each interface of each recording becomes an interface of its own. The packets of one recording
    keep their order, even where their times decrease: it is the order of the streams.

    Returns:
        The interfaces of the merged file, by their numbers; what the sources lack.

    Raises:
        UsageError: a source has several sections or is big-endian; there are too many interfaces.
        CaptureError: a source is damaged.
    """
    found: list[MergedInterface] = []
    with ExitStack() as stack:
        files = [stack.enter_context(block_file(source, progress)) for source in sources]
        write = stack.enter_context(_output(output, overwrite, sources))
        merging = [_Source(file) for file in files]
        # Packets without a comment are frames in our recordings, and chunks in those of others.
        ours = all(source.application.startswith(OURS) for source in merging)
        comments = [comment for source in merging for comment in source.comments]
        write(blocks.section(OURS if ours else "merged recordings", comments))
        timed = [source.blocks(number) for number, source in enumerate(merging)]
        for time_ns, number, block in heapq.merge(*timed, key=lambda item: item[:2]):
            write(merging[number].renumbered(time_ns, block, found))
        return found, [f"{file.name}: {file.incomplete}" for file in files if file.incomplete]


class _Source:
    """A recording to merge."""

    def __init__(self, file: BlockFile) -> None:
        self._file, self._parser = file, PacketParser(file.name)
        # The numbers of its interfaces in the merged file.
        self._numbers: list[int] = []
        header = next(iter(file))
        self._parser.take(header.parsed)
        self.application = self._parser.application
        if header.order == ">":
            raise self._unusable("it is big-endian; editcap IN OUT converts it")
        fields = Fields(header.parsed, file.name)
        fields.numbers("IHHq")
        program = self.application or "a program without a name"
        origin = f"merged from {file.name}, recorded by {program}"
        self.comments = [f"{origin}; times are those of the recording computer"]
        self.comments += [decoded(it) for code, it in fields.options() if code == blocks.COMMENT]

    def blocks(self, number: int) -> Iterator[tuple[int, int, StoredBlock]]:
        """Yield the blocks after the first, each with the time of its packet or the one before."""
        time_ns = -_ALWAYS
        for block in self._file:
            if block.kind == blocks.SECTION:
                raise self._unusable(f"it has a second section, at byte {block.offset}")
            if block.kind == blocks.PACKET:
                time_ns = self._parser.time_ns(block.parsed)
            else:
                self._parser.take(block.parsed)
            yield time_ns, number, block

    def renumbered(self, time_ns: int, block: StoredBlock, found: list[MergedInterface]) -> bytes:
        """Return a block for the merged file, which has the interfaces ``found`` so far."""
        if block.kind == blocks.INTERFACE:
            if len(found) >= MOST_INTERFACES:
                raise self._unusable(f"together they have more than {MOST_INTERFACES} interfaces")
            # The parser is one block ahead.
            interface = self._parser.interfaces[len(self._numbers)]
            self._numbers.append(len(found))
            found.append(MergedInterface(self._file.name, interface))
        elif block.kind in (blocks.PACKET, blocks.STATISTICS):
            (index,) = struct.unpack_from("<I", block.data, 8)
            number = self._numbers[index]
            if block.kind == blocks.PACKET:
                found[number].add(time_ns)
            return block.data[:8] + struct.pack("<I", number) + block.data[12:]
        return block.data

    def _unusable(self, why: str) -> UsageError:
        message = f"{self._file.name} cannot be merged: {why}"
        return UsageError("FILE", self._file.name, message=message)


class Loss(NamedTuple):
    """The bytes from ``begin`` up to ``end`` of a file, which are not in the repaired one."""

    begin: int
    end: int
    why: str


class Repair:
    """Checks the blocks of a recording, and counts what is kept and lost.

    Attributes:
        packets: how many packets were kept.
        losses: the first ranges of bytes that were lost.
        lost_ranges, lost_bytes: the numbers of all lost ranges and bytes.
        marked: the number of interfaces that this repair marked as finished.
    """

    def __init__(self) -> None:
        self.packets = self.lost_ranges = self.lost_bytes = self.marked = 0
        self.losses: list[Loss] = []
        # The statistics to write before the next section.
        self._marks = b""
        # The state of the current section: its parser, its byte order, the bytes that were lost
        # before it, and the last time stamp of each interface, or None after its statistics.
        self._parser, self._order = PacketParser(""), "<"
        self._lost_before = 0
        self._last: list[int | None] = []

    def lose(self, begin: int, end: int, why: str) -> None:
        """Count a range of lost bytes; adjacent ranges with the same reason are one range."""
        self.lost_bytes += end - begin
        last = self.losses[-1] if self.losses else None
        if last is not None and (last.end, last.why) == (begin, why):
            self.losses[-1] = last._replace(end=end)
            return
        self.lost_ranges += 1
        if len(self.losses) < _LISTED:
            self.losses.append(Loss(begin, end, why))

    def take(self, block: StoredBlock, name: str) -> bytes:
        """Check the next block; return what to write for it.

        Raises:
            CaptureError: the block is damaged, or earlier damage makes it ambiguous.
        """
        if block.kind == blocks.SECTION:
            self._marks, self._parser = self.marks(), PacketParser(name)
            self._lost_before, self._order = self.lost_bytes, block.order
            self._parser.take(block.parsed)
            marks, self._marks = self._marks, b""
            return marks + _as_stored(block)
        if block.kind == blocks.PACKET:
            index, stamp = self._parser.stamp(block.parsed)
            self.packets += 1
            self._last[index] = max(stamp, self._last[index] or 0)
        elif block.kind == blocks.INTERFACE:
            # A lost block may have described an interface. Then this one would wrongly get that
            # interface's number.
            if self.lost_bytes > self._lost_before:
                raise damaged(name, block.offset, "interface-lost")
            self._parser.take(block.parsed)
            self._last.append(0)
        elif block.kind == blocks.STATISTICS:
            self._parser.take(block.parsed)
            (index,) = struct.unpack_from(block.order + "I", block.data, 8)
            self._last[index] = None
        return block.data

    def marks(self) -> bytes:
        """Return the statistics that our sections lack at their ends."""
        ours = self._parser.application.startswith(OURS) and self._order == "<"
        missing = [(index, last) for index, last in enumerate(self._last) if last is not None]
        self._last = []
        self.marked += len(missing) * ours
        return self._marks + b"".join(blocks.end_mark(*each) for each in missing if ours)


def repair(
    source: SourcePath,
    output: SourcePath,
    *,
    overwrite: bool = False,
    progress: Progress = lambda size: None,
) -> Repair:
    """Write the whole blocks of a recording, and mark the recording as finished.

    A recording that is whole is copied. Only recordings of cobotwire are marked as finished.
    """
    done = Repair()
    with (
        block_file(source, progress, done.lose) as file,
        _output(output, overwrite, [source]) as write,
    ):
        for block in file:
            try:
                write(done.take(block, file.name))
            except CaptureError as error:
                if block.offset == 0:
                    raise
                done.lose(block.offset, block.offset + len(block.data), error.detail)
        write(done.marks())
    return done
