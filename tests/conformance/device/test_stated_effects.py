"""A device that ignores a command fails if a query can report the stated effect."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from conformance.device.testing import Altered, permissions, prepared
from trial_specs import FOOTED, HEAD, package_of

PUMP = f"""{HEAD}joints: 0
{FOOTED}
types:
  wire:
    byte: {{bytes: 1, doc: A byte.}}
    word: {{bytes: 2, order: big, signed_at: 32767, doc: A word.}}
  quantities:
    count: {{wire: byte, doc: A number of values.}}
    volume: {{wire: word, scale: 1/10, doc: A volume.}}
  flags: {{flag: {{wire: byte, doc: 1 is yes.}}}}
  enums:
    valve: {{wire: byte, class: Valve, doc: A valve., members: {{
      CLOSE: {{value: 0, doc: Closes.}}, OPEN: {{value: 1, doc: Opens.}}}}}}
state:
  open: {{type: flag}}
  doses: {{type: volume}}
  marks: {{type: volume}}
  lost: {{type: volume}}
  filled: {{type: volume, each: valve}}
commands:
"""
VOLUME = "[{name: volume, type: volume}]"
COMMANDS = {
    "set_valve": "request: [{name: action, type: valve}], effect: {selector: action,"
    " cases: {CLOSE: {sets: {open: false}}, OPEN: {sets: {open: true}}}}",
    "is_open": "reply: [{name: open, type: flag}], effect: {reports: open}",
    "add_dose": f"request: {VOLUME}, effect: {{list: doses, append: volume}}",
    "take_dose": f"reply: {VOLUME}, effect: {{list: doses, take: first, empty: zeros}}",
    "add_mark": f"request: {VOLUME}, effect: {{list: marks, append: volume}}",
    "has_no_mark": "reply: [{name: none, type: flag}], effect: {list: marks, report: empty}",
    "count_marks": "reply: [{name: count, type: count}], effect: {list: marks, report: count}",
    "clear_marks": "effect: {list: marks, clear: all}",
    "lose": f"request: {VOLUME}, effect: {{list: lost, append: volume}}",
    "fill": "request: [{name: slot, type: valve}, {name: volume, type: volume}], effect: {"
    "selector: slot, cases: {OPEN: {stores: {volume: filled}, at: slot},"
    " CLOSE: {unknown: No source says.}}}",
    "get_filled": f"request: [{{name: slot, type: valve}}], reply: {VOLUME},"
    " effect: {reports: {volume: filled}, at: slot}",
}
QUERIES = ("is_open", "has_no_mark", "count_marks", "get_filled")


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """Yield the table of a pump whose commands have cases and lists."""
    lines = (
        f"  {name}: {{id: {id}, title: T, doc: D., {rest}, "
        f"safety: {'query' if name in QUERIES else 'setting'}}}\n"
        for id, (name, rest) in enumerate(COMMANDS.items(), 0x10)
    )
    with package_of(PUMP + "".join(lines), tmp_path_factory.mktemp("pump")) as package:
        yield package.TABLE


def test_pump_that_does_what_is_stated_conforms(table: Any) -> None:
    report = prepared(table, permissions=permissions("setting", "irreversible", joints=0)).run()
    assert [(r.case, r.command, r.reason) for r in report.failures] == []
    assert report.untested == "Not tested: the effect of lose; only the response was checked."


@pytest.mark.parametrize(
    ("ignored", "case"),
    [
        ("set_valve", "effect"),
        ("add_dose", "points-in-order"),
        ("add_mark", "points-in-order"),
        ("clear_marks", "list-cleared"),
        ("fill", "read-back"),
    ],
)
def test_ignored_command_fails(table: Any, ignored: str, case: str) -> None:
    id = bytes([table.command(ignored).id])

    class Ignoring(Altered):
        def receive(self, data: bytes) -> bytes:
            return b"" if data[3:4] == id else super().receive(data)

    tester = prepared(table, lambda arm: Ignoring(arm, lambda request, reply, count: reply))
    assert (case, ignored) in {(r.case, r.command) for r in tester.run().failures}


def test_list_that_may_be_lost_needs_the_permission_irreversible(table: Any) -> None:
    report = prepared(table, permissions=permissions("setting", joints=0)).run()
    assert report.conforms
    skipped = {r.command for r in report.results if "permission: irreversible" in r.reason}
    assert skipped == {"add_dose", "add_mark", "clear_marks", "lose", "take_dose"}
