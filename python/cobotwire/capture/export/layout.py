"""Decide which file the rows of a batch belong in."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pyarrow as pa
import pyarrow.compute as pc

from cobotwire.capture.export.batch import Batch
from cobotwire.capture.export.formats import Format
from cobotwire.capture.export.plan import ExportPlan, Message
from cobotwire.capture.export.tables import messages_of
from cobotwire.protocol.errors import UsageError

# The name that Hive gives to the folder of rows without a value.
NO_VALUE = "__HIVE_DEFAULT_PARTITION__"


class Layout:
    """Names the files of a plan."""

    def __init__(self, plan: ExportPlan, format: Format) -> None:
        """Check whether the plan's output can hold its messages.

        Raises:
            UsageError: the output is a single file, but the plan has several messages.
        """
        self._plan, self._format = plan, format
        self.single = Path(plan.output).suffix in format.suffixes
        if self.single:
            self._check_single()

    def _check_single(self) -> None:
        output = self._plan.output
        if self._plan.partition:
            message = f"{output} is one file: give a folder to partition the rows"
            raise UsageError("output", output, message=message)
        if self._format.per_message and len(chosen := self.chosen()) != 1:
            labels = ", ".join(message.label for message in chosen[:3])
            more = f" and {len(chosen) - 3} more" if len(chosen) > 3 else ""
            message = (
                f"{output} is one file for one message, but the export has {labels}{more}: choose "
                "one with --command and --direction, or give a folder"
            )
            raise UsageError("output", output, message=message)

    def chosen(self) -> list[Message]:
        """Return the messages of the default edition that the plan writes."""
        messages = messages_of(self._plan.editions.codec("").table)
        return [message for message in messages if self._plan.chooses(message)]

    def split(self, batch: Batch) -> Iterator[tuple[Path, Batch]]:
        """Yield the rows of a batch with the path of their file."""
        if "day" not in self._plan.partition:
            yield self._path(batch, ""), batch
            return
        days = pc.strftime(batch.table.column("time"), "%Y-%m-%d").combine_chunks()
        for day in days.unique():
            rows = pc.is_null(days) if day.as_py() is None else pc.equal(days, day)
            part = batch._replace(table=batch.table.filter(rows))
            yield self._path(batch, day.as_py() or NO_VALUE), part

    def without_keys(self, table: Any) -> Any:
        """Return a table without the columns whose values are in the names of folders."""
        dropped = [key for key in self._plan.partition if key == "robot"]
        return table.drop_columns(dropped) if dropped else table

    def other(self, path: Path, edition: str) -> Path:
        """Return the path for rows of another edition, where the message has other columns."""
        return path.with_name(f"{path.stem}.{edition}{path.suffix}")

    def next_part(self, path: Path, number: int) -> Path:
        """Return the path of a further file for the rows that belong in ``path``."""
        return path.with_name(f"{path.stem}-{number}{path.suffix}")

    def _path(self, batch: Batch, day: str) -> Path:
        output = Path(self._plan.output)
        if self.single:
            return output
        values = {"robot": batch.robot, "command": batch.message.command, "day": day}
        folders = [f"{key}={quote(values[key], safe='')}" for key in self._plan.partition]
        stem = batch.message.label if self._format.per_message else "messages"
        part = f"-{self._plan.part}" if self._plan.part else ""
        return output.joinpath(*folders, f"{stem}{part}{self._format.suffixes[0]}")


def empty_table(schema: Any) -> Any:
    """Return a table without rows."""
    return pa.Table.from_batches([], schema=schema)
