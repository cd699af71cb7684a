"""Export bytes and recordings, and compute what the files must contain."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from enum import IntEnum
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq

from cobotwire import codec as codecs
from cobotwire.capture import CaptureWriter, Interface, Packet
from cobotwire.capture.export import ExportPlan, Inputs, Report, write
from cobotwire.codec.interface import Frame, Listening
from cobotwire.codec.table_columns import column_name
from cobotwire.editions import DEFAULT, load
from cobotwire.inspect.exporting import InstalledEditions
from cobotwire.protocol.errors import ProtocolError

CODEC = codecs.load(load().TABLE)
START = 1_795_400_000_000_000_000
# The columns before the fields.
OWN = ("robot", "source", "offset", "time")

Rows = dict[str, list[dict[str, Any]]]


def export(output: Path, *inputs: Path | str, edition: str = DEFAULT, **choices: Any) -> Report:
    """Export inputs with a plan of these choices."""
    plan = ExportPlan(str(output), InstalledEditions(edition), **choices)
    return write(plan, Inputs.find([*map(str, inputs)]))


def reply(command: str, *values: Any) -> bytes:
    """Return the frame of a reply of the default edition."""
    return CODEC.encode(command, "reply", values)


def request(command: str, *values: Any) -> bytes:
    """Return the frame of a request of the default edition."""
    return CODEC.encode(command, "request", values)


def recording(path: Path, packets: Iterable[Packet], *editions: str, finish: bool = True) -> Path:
    """Write a recording with an interface for each edition."""
    with path.open("wb") as file:
        writer = CaptureWriter(file)
        for number, edition in enumerate(editions or (DEFAULT,)):
            writer.interface(Interface(f"/dev/ttyACM{number}", edition, 1_000_000))
        for packet in packets:
            writer.packet(packet)
        if finish:
            writer.finish()
    return path


def polled(rounds: int, step_ns: int = 20_000_000) -> list[Packet]:
    """Return the packets of an arm that is polled for its angles."""
    made = []
    for number in range(rounds):
        time = START + number * step_ns
        angles = [round(number * 0.01 + joint, 2) for joint in range(6)]
        made.append(Packet(time, "sent", request("get_angles")))
        made.append(Packet(time + 3_000_000, "received", reply("get_angles", angles)))
    return made


def typed_rows(data: bytes, listening: Listening, edition: str = DEFAULT) -> tuple[Rows, int]:
    """Return the typed messages of raw bytes by label, and the number of rejected frames."""
    framer = codecs.load(load(edition).TABLE).framer(listening)
    rows: Rows = defaultdict(list)
    rejected = 0
    for event in [*framer.feed(data), *framer.flush()]:
        if isinstance(event, Frame):
            try:
                message = event.message
            except ProtocolError:
                rejected += 1
                continue
            typed = message.typed
            # A typed message leaves out constants.
            fields = {
                column_name(name, message.direction): plain(getattr(typed, name, value))
                for name, value in message.fields.items()
            }
            label = f"{message.command.name}.{message.direction}"
            rows[label].append({"offset": event.offset, **fields})
    return dict(rows), rejected


def plain(value: Any) -> Any:
    """Return a typed value as a file holds it: enum members by name, rows as lists."""
    if isinstance(value, IntEnum):
        return value.name
    if isinstance(value, tuple):
        return [plain(each) for each in value]
    return value


def read_rows(folder: Path) -> Rows:
    """Return the rows of the Parquet files of an export by label, in the form of typed_rows."""
    found: Rows = {}
    for path in sorted(folder.rglob("*.parquet")):
        rows = pq.ParquetFile(path).read().to_pylist()
        found[path.stem] = [as_typed(row) for row in rows]
    return found


def as_typed(row: dict[str, Any]) -> dict[str, Any]:
    """Return a row without our columns, and without the fields that its variant lacks."""
    hidden = ("robot", "source", "time")
    kept = {name: value for name, value in row.items() if name not in hidden}
    return {name: value for name, value in kept.items() if value is not None}
