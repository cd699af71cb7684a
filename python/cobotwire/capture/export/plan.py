"""Define what an export writes: which messages, in which format, where."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, Protocol, get_args

from cobotwire.codec.interface import Codec, Listening
from cobotwire.protocol.errors import UsageError, did_you_mean
from cobotwire.protocol.table import Direction

FormatName = Literal["parquet", "csv", "arrow", "mcap"]
Key = Literal["robot", "command", "day"]
Compression = Literal["zstd", "snappy", "lz4", "none"]
# The pose of the arm's end for joint angles in degrees: x y z in millimetres, rx ry rz in degrees.
Forward = Callable[[Sequence[float]], tuple[float, ...]]


class Message(NamedTuple):
    """A message of an edition: the request or the reply of a command."""

    command: str
    direction: Direction

    @property
    def label(self) -> str:
        """The name of the message in files and reports, such as ``get_angles.reply``."""
        return f"{self.command}.{self.direction}"


class Editions(Protocol):
    """Finds editions for an export. Implementations can be pickled, for other processes."""

    def codec(self, name: str) -> Codec:
        """Return the codec of an edition, or of the default edition if the name is empty."""
        ...

    def forward(self, name: str) -> Forward | None:
        """Return the kinematics of the edition's arm; None if its geometry is not known."""
        ...

    def has_command(self, command: str) -> bool:
        """Return whether any edition has a command of that name."""
        ...


@dataclass(frozen=True, slots=True)
class ExportPlan:
    """What an export writes. It can be pickled, so that other processes can export with it.

    Attributes:
        output: a folder, or the name of a single file.
        editions: finds the editions; ``""`` is the edition of inputs that name none.
        format: the format of the files.
        commands: the commands to write; empty for all.
        direction: the messages to write; also what raw bytes hold.
        begin_ns: the first time to write, in nanoseconds since 1970 (UTC); None for all.
        end_ns: the first time not to write; None for all.
        wide: whether a field of several numbers becomes several columns.
        gap_ns: a longer pause between two messages of a recording counts as a gap.
        partition: hive-style folders by these keys, from the outermost on.
        compression: how Parquet and Arrow files are compressed.
        overwrite: whether existing files are replaced.
        read_as: the format of the inputs; empty to detect it.
        ports: the TCP ports of arms in captures of networks; empty for the usual ones.
        part: added to the names of files, so that several processes can write into one folder.
    """

    output: str
    editions: Editions
    format: FormatName = "parquet"
    commands: tuple[str, ...] = ()
    direction: Listening = "both"
    begin_ns: int | None = None
    end_ns: int | None = None
    wide: bool = False
    gap_ns: int = 1_000_000_000
    partition: tuple[Key, ...] = ()
    compression: Compression = "zstd"
    overwrite: bool = False
    read_as: str = ""
    ports: tuple[int, ...] = ()
    part: str = ""

    def __post_init__(self) -> None:
        for argument, value, allowed in (
            ("format", self.format, get_args(FormatName)),
            ("compression", self.compression, get_args(Compression)),
            ("direction", self.direction, get_args(Listening)),
            *(("partition", key, get_args(Key)) for key in self.partition),
        ):
            if value not in allowed:
                hint = did_you_mean(value, allowed)
                raise UsageError(argument, value, f"{', '.join(allowed)}{hint}")
        if self.wide and self.format == "mcap":
            message = "wide columns are for tables: an MCAP message has no columns"
            raise UsageError("wide", self.wide, message=message)
        check_range(self.begin_ns, self.end_ns)
        check_commands(self.commands, self.editions)

    @property
    def needs_times(self) -> bool:
        """Whether every row must have a time."""
        return self.format == "mcap" or (self.begin_ns, self.end_ns) != (None, None)

    def chooses(self, message: Message) -> bool:
        """Return whether the plan writes a message."""
        by_name = not self.commands or message.command in self.commands
        return by_name and self.direction in (message.direction, "both")


def check_commands(commands: Iterable[str], editions: Editions) -> None:
    """Raise UsageError for a command that neither the default edition nor another one has."""
    table = editions.codec("").table
    known = {command.name for command in table.commands}
    for command in commands:
        if command not in known and not editions.has_command(command):
            table.command(command)


def check_range(begin_ns: int | None, end_ns: int | None) -> None:
    """Raise UsageError for a range of time that is empty."""
    if begin_ns is not None and end_ns is not None and begin_ns >= end_ns:
        message = "the time range is empty: it ends before it begins"
        raise UsageError("end", end_ns, message=message)
