"""Write messages to an MCAP file, which Foxglove, PlotJuggler and other robotics tools open.

Each message of each robot is a channel with JSON objects; so is each message of each device, if
several devices share a line. The angles of the joints and the pose of the arm's end are also
messages of ROS 2.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from heapq import merge
from typing import Any, BinaryIO, NamedTuple

from mcap.writer import Writer

from cobotwire.capture.export.batch import Batch
from cobotwire.capture.export.formats import mcap_schemas as schemas
from cobotwire.capture.export.formats.mcap_motion import Motion
from cobotwire.capture.export.plan import ExportPlan
from cobotwire.capture.export.ros_messages import schema_text, serialised
from cobotwire.capture.export.tables import OWN

# Rows that become Python objects at a time.
ROWS = 4096


class Record(NamedTuple):
    """A message of a channel: when, where, and its content."""

    time_ns: int
    channel: int
    data: bytes


class Encoding(NamedTuple):
    """How MCAP names the language of a schema, and the encoding of the messages."""

    schema: str
    message: str


JSON, ROS_2 = Encoding("jsonschema", "json"), Encoding("ros2msg", "cdr")


class McapSink:
    """Writes the messages of a block in the order of their times."""

    def __init__(self, writer: Writer, plan: ExportPlan) -> None:
        self._writer, self._plan = writer, plan
        self._channels: dict[str, int] = {}
        self._schemas: dict[str, int] = {}
        self._motions: dict[str, Motion] = {}

    def write(self, batches: list[Batch]) -> None:
        """Append messages."""
        for record in merge(*map(self._records, batches)):
            self._writer.add_message(
                record.channel, record.time_ns, record.data, publish_time=record.time_ns
            )

    def close(self) -> None:
        """Write the index."""
        self._writer.finish()  # type: ignore[no-untyped-call]

    def _records(self, batch: Batch) -> Iterator[Record]:
        """Yield the records of a batch, in the order of its rows."""
        motion = self._motion(batch.edition)
        title = f"cobotwire.{batch.message.label}"
        schema = json.dumps(schemas.of_table(title, batch.table.schema))
        name = f"{batch.message.command}/{batch.message.direction}"
        for block in batch.table.to_batches(max_chunksize=ROWS):
            times = block.column("time").cast("int64").to_pylist()
            dropped = [name for name in block.schema.names if name in OWN]
            rows = zip(times, _devices(batch, block), block.drop_columns(dropped).to_pylist())
            for time_ns, device, fields in rows:
                channel = self._channel(f"{device}/{name}", batch.edition, title, schema, JSON)
                yield Record(time_ns, channel, _json(fields))
                for topic, kind, content in motion.derived(batch.message, fields, time_ns, device):
                    text = schema_text(kind)
                    channel = self._channel(f"{device}/{topic}", batch.edition, kind, text, ROS_2)
                    yield Record(time_ns, channel, serialised(kind, content))

    def _motion(self, edition: str) -> Motion:
        if edition not in self._motions:
            self._motions[edition] = Motion(self._plan.editions, edition)
        return self._motions[edition]

    def _channel(
        self, topic: str, edition: str, title: str, schema: str, encoding: Encoding
    ) -> int:
        if topic not in self._channels:
            if title not in self._schemas:
                self._schemas[title] = self._writer.register_schema(
                    title, encoding.schema, schema.encode()
                )
            table = self._plan.editions.codec(edition).table
            self._channels[topic] = self._writer.register_channel(
                topic, encoding.message, self._schemas[title], {"edition": table.edition}
            )
        return self._channels[topic]


def open_sink(file: BinaryIO, schema: Any, plan: ExportPlan) -> McapSink:
    """Return a sink for a file."""
    writer = Writer(file)
    writer.start(library="cobotwire")
    return McapSink(writer, plan)


def _devices(batch: Batch, block: Any) -> list[str]:
    """Return the start of the topics of each row: its robot, and its device if rows name one."""
    robot = f"/{batch.robot}"
    if "address" not in block.schema.names:
        return [robot] * block.num_rows
    return [f"{robot}/{name.lower()}" for name in block.column("address").to_pylist()]


def _json(value: Any) -> bytes:
    """Return a value as JSON; bytes are hex, and numbers that JSON lacks are null."""
    try:
        return json.dumps(value, default=bytes.hex, allow_nan=False).encode()
    except ValueError:
        return json.dumps(_finite(value), default=bytes.hex).encode()


def _finite(value: Any) -> Any:
    """Return a value with None for each number that is infinite or not a number."""
    if isinstance(value, dict):
        return {name: _finite(each) for name, each in value.items()}
    if isinstance(value, list):
        return [_finite(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
