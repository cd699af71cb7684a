"""Print the items of a decoded stream, and count them."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from cobotwire.cli.shared.exit_codes import OUTPUT_CLOSED
from cobotwire.cli.shared.hex_colours import frame_colours
from cobotwire.cli.shared.item_formats import Format, as_object, byte_by_byte, one_line
from cobotwire.cli.shared.output import discard_output, fold
from cobotwire.codec.interface import Codec, Listening
from cobotwire.diagnose.counts import StreamCounts
from cobotwire.diagnose.explain import DIRECTIONS, FrameReader

if TYPE_CHECKING:
    from cobotwire.diagnose import Item


class DecodeOptions(NamedTuple):
    """What to print, and how."""

    edition: str
    direction: Listening
    accept_unknown: bool
    each_byte: bool
    as_json: bool
    quiet: bool
    # The name of the file, if there are several.
    file: str | None = None


class StreamPrinter:
    """Counts the items of one stream, and prints them."""

    def __init__(
        self, codec: Codec, listening: Listening, options: DecodeOptions, counts: StreamCounts
    ) -> None:
        directions = tuple(d for d in DIRECTIONS if listening in (d, "both"))
        self.reader = FrameReader(codec, directions)
        self._counts, self._options = counts, options
        self._file = {} if options.file is None else {"file": options.file}
        self._format = self._choose_format(codec)

    def _choose_format(self, codec: Codec) -> Format:
        if self._options.as_json:
            return lambda item: json.dumps({**self._file, **as_object(self.reader, item)})
        colour = sys.stdout.isatty() and not os.environ.get("NO_COLOR")
        paint = frame_colours(codec.table.frame) if colour else None
        if self._options.each_byte:
            return byte_by_byte(self.reader, codec.table, paint)
        return one_line(self.reader, paint)

    def print(self, items: Sequence[Item]) -> None:
        """Count and print items."""
        self._counts.add(items, self.reader)
        if items and not self._options.quiet:
            text = "\n".join(map(self.format, items))
            print_text(text if self._options.as_json else fold(text))

    def format(self, item: Item) -> str:
        """Format one item."""
        return self._format(item)


def print_text(text: str) -> None:
    """Print a text and a line feed; exit if the reader of the output has closed it."""
    write_text(text + "\n")


def write_text(text: str) -> None:
    """Print a text; exit if the reader of the output has closed it."""
    try:
        sys.stdout.write(text)
        # After each block, so that live input is shown as it comes.
        sys.stdout.flush()
    except BrokenPipeError:
        discard_output()
        sys.exit(OUTPUT_CLOSED)
