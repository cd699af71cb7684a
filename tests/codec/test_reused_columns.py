"""``out=`` takes the memory of all earlier columns, or leaves all of them unchanged."""

from __future__ import annotations

import sys
import sysconfig
import threading
from typing import Any

import numpy as np
import pytest

import small_tables
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Columns
from cobotwire.editions import mycobot280
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.table import Table, Variant

ANGLES = bytes.fromhex("FE FE 0E 20 00 64 00 C8 01 2C 01 90 01 F4 02 8A FA")
FLAG = bytes.fromhex("FE FE 03 12 01 FA")


class ViewingCommand:
    """A command that makes a view when its name is read, as another thread might at that time."""

    def __init__(self, name: str, exporter: Any) -> None:
        self._name, self._exporter = name, exporter
        self.views: list[memoryview] = []

    @property
    def name(self) -> str:
        self.views.append(memoryview(self._exporter))
        return self._name


def found(columns: Columns) -> Any:
    """Return the offsets and the values of all rows, and the addresses if there are any."""
    return [
        (
            each.offset.tolist(),
            [each[name].tolist() for name in each.names],
            *([] if each.address is None else [each.address.tolist()]),
        )
        for each in columns
    ]


@pytest.mark.parametrize("viewed", [0, 1])
def test_view_made_during_a_native_call_leaves_all_columns_unchanged(viewed: int) -> None:
    codec = codecs.load(TABLE, "native")
    out = codec.decode_columns(ANGLES * 3 + FLAG, "reply")
    before = found(out)
    commands = [rows.command for rows in out]
    viewing: Any = ViewingCommand(commands[0].name, out[viewed]._offset)
    out[0].command = viewing
    with pytest.raises(BufferError, match="out is still used"):
        codec.decode_columns(ANGLES, "reply", out=out)
    assert viewing.views, "the view was made during the call"
    out[0].command = commands[0]
    assert found(out) == before
    for view in viewing.views:
        assert list(view) == list(out[viewed].offset)
        view.release()
    codec.decode_columns(ANGLES, "reply", out=out)
    assert len(out) == 0


@pytest.mark.parametrize("call", ["scan", "decode_columns"])
def test_noise_of_out_is_reused_unless_it_is_viewed(call: str) -> None:
    codec = codecs.load(TABLE, "native")
    read: Any = getattr(codec, call)
    stream = (b"\x07" + ANGLES) * 50_000
    out = read(stream, "reply")
    first = out.noise
    starts, address = first.offset.tolist(), _address(first.offset)
    with pytest.raises(BufferError, match="out is still used"):
        read(stream, "reply", out=out)
    assert out.noise.offset.tolist() == starts, "a refused call leaves the noise"
    assert len(out.offset if call == "scan" else out[0].offset) == 50_000
    first.offset.release()
    first.size.release()
    again = read(stream, "reply", out=out)
    assert again.noise.offset.tolist() == starts
    assert _address(again.noise.offset) == address
    assert len(out.noise.offset) == 0


def _address(view: memoryview) -> int:
    return int(np.asarray(view).__array_interface__["data"][0])


def test_noise_of_longer_out_is_not_in_the_result(codec: Codec) -> None:
    out = codec.scan((b"\x07" + ANGLES) * 9, "reply")
    columns = codec.decode_columns((b"\x07" + ANGLES) * 9, "reply")
    assert codec.scan(ANGLES + b"\x08\x09", "reply", out=out).noise.size.tolist() == [2]
    found = codec.decode_columns(ANGLES + b"\x08\x09", "reply", out=columns)
    assert [list(each) for each in found.noise] == [[17], [2]]


def test_out_with_commands_that_the_edition_lacks_is_accepted(codec: Codec) -> None:
    # ``out`` may come from another edition.
    table = small_tables.table(
        small_tables.command(
            1, "unknown", (Variant((small_tables.field("a", small_tables.number()),)),)
        )
    )
    other = codecs.load(table, codec.name)
    data = other.encode("unknown", "request", (7,)) * 3
    out = other.decode_columns(data, "request")
    assert len(out) == 1
    columns = codec.decode_columns(ANGLES, "reply", out=out)
    assert found(columns) == [([0], [[[1.0, 2.0, 3.0, 4.0, 5.0, 6.5]]])]


def test_out_of_a_table_with_other_variants_is_accepted(codec: Codec) -> None:
    # A command of the same name need not have the same fields, variants or reply.
    changed = mycobot280.TABLE._replace(commands=tuple(_without_reply(mycobot280.TABLE)))
    out = codecs.load(mycobot280.TABLE, codec.name).decode_columns(ANGLES * 2 + FLAG, "reply")
    other = codecs.load(changed, codec.name)
    request = other.encode("get_angles", "request", ())
    assert len(other.decode_columns(request, "both", out=out)) == 1


def _without_reply(table: Table) -> Any:
    for command in table.commands:
        yield command._replace(reply=()) if command.name == "get_angles" else command


def test_views_and_reuse_in_several_threads_never_change_a_viewed_column(codec: Codec) -> None:
    # A view shows the three rows of the earlier columns, or none if their memory is already reused.
    stream = ANGLES * 3 + FLAG
    shared = codec.decode_columns(stream, "reply")
    seen: list[Any] = []

    def look() -> None:
        for _ in range(2000):
            for rows in list(shared):
                offsets = rows.offset
                before = list(offsets)
                again = list(offsets)
                seen.append((len(before) in (0, 1, 3), before == again))

    threads = [threading.Thread(target=look) for _ in range(2)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        try:
            shared = codec.decode_columns(stream, "reply", out=shared)
        except BufferError:
            continue
    for thread in threads:
        thread.join()
    assert set(seen) == {(True, True)}


@pytest.mark.skipif(
    not sysconfig.get_config_var("Py_GIL_DISABLED"),
    reason="this interpreter is not free-threaded",
)
def test_native_codec_enables_the_lock_of_a_free_threaded_interpreter() -> None:
    # The native codec does not claim to be safe without the lock, since no test shows that.
    import cobotwire._native

    assert cobotwire._native
    assert sys._is_gil_enabled()  # type: ignore[attr-defined]
