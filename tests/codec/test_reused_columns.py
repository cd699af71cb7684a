"""``out=`` takes the memory of earlier columns all at once, or leaves them as they were."""

from __future__ import annotations

import sys
import sysconfig
import threading
from dataclasses import replace
from typing import Any

import pytest

import small_tables
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Columns
from cobotwire.editions import mycobot280
from cobotwire.protocol.table import Table, Variant

ANGLES = bytes.fromhex("FE FE 0E 20 00 64 00 C8 01 2C 01 90 01 F4 02 8A FA")
FLAG = bytes.fromhex("FE FE 03 12 01 FA")


class Nosy:
    """Stands for a command; whoever reads its name gives another thread time to make a view."""

    def __init__(self, name: str, exporter: Any) -> None:
        self._name, self._exporter = name, exporter
        self.views: list[memoryview] = []

    @property
    def name(self) -> str:
        self.views.append(memoryview(self._exporter))
        return self._name


def found(columns: Columns) -> Any:
    """Return the offsets and the values of all rows."""
    return [
        (each.offset.tolist(), [each[name].tolist() for name in each.names]) for each in columns
    ]


@pytest.mark.parametrize("viewed", [0, 1])
def test_view_made_during_the_call_leaves_all_columns_as_they_were(
    codec: Codec, viewed: int
) -> None:
    out = codec.decode_columns(ANGLES * 3 + FLAG, "reply")
    before = found(out)
    commands = [rows.command for rows in out]
    nosy: Any = Nosy(commands[0].name, out[viewed]._offset)
    out[0].command = nosy
    if codec.name == "native":
        with pytest.raises(BufferError, match="out is still used"):
            codec.decode_columns(ANGLES, "reply", out=out)
        assert nosy.views, "the view was made during the call"
    out[0].command = commands[0]
    assert found(out) == before
    for view in nosy.views:
        assert list(view) == list(out[viewed].offset)
        view.release()
    if codec.name == "native":
        codec.decode_columns(ANGLES, "reply", out=out)
        assert len(out) == 0


def test_columns_with_commands_that_the_edition_lacks_are_no_error(codec: Codec) -> None:
    """The reference keeps the memory of any ``out``, whatever edition it is of."""
    table = small_tables.table(
        small_tables.command(
            1, "nobody_knows", (Variant((small_tables.field("a", small_tables.number()),)),)
        )
    )
    other = codecs.load(table, codec.name)
    data = other.encode("nobody_knows", "request", (7,)) * 3
    out = other.decode_columns(data, "request")
    assert len(out) == 1
    columns = codec.decode_columns(ANGLES, "reply", out=out)
    assert found(columns) == [([0], [[[1.0, 2.0, 3.0, 4.0, 5.0, 6.5]]])]


def test_columns_of_a_variant_with_other_fields_are_no_error(codec: Codec) -> None:
    """A command of the same name need not have the same fields, variants or reply."""
    alike = replace(mycobot280.TABLE, commands=tuple(_without_reply(mycobot280.TABLE)))
    out = codecs.load(mycobot280.TABLE, codec.name).decode_columns(ANGLES * 2 + FLAG, "reply")
    other = codecs.load(alike, codec.name)
    request = other.encode("get_angles", "request", ())
    assert len(other.decode_columns(request, "both", out=out)) == 1


def _without_reply(table: Table) -> Any:
    for command in table.commands:
        yield replace(command, reply=()) if command.name == "get_angles" else command


def test_views_and_reuse_in_several_threads_never_change_a_viewed_column(codec: Codec) -> None:
    """A view shows the three rows there were, or none if the memory was taken before."""
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
    not sysconfig.get_config_var("Py_GIL_DISABLED"), reason="this interpreter always has its lock"
)
def test_free_threaded_interpreter_takes_its_lock_again() -> None:
    """Nothing shows yet that the native codec is sound without it, so it does not claim that."""
    import cobotwire._native

    assert cobotwire._native
    assert sys._is_gil_enabled()  # type: ignore[attr-defined]
