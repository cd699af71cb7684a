"""Test scenario files: valid ones are read, bad ones are rejected with exact messages."""

from __future__ import annotations

import re
import subprocess
import sys
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ruamel.yaml import YAML

import vectors
from cobotwire.editions import mycobot, mycobot280
from cobotwire.protocol.errors import ScenarioError, UsageError
from cobotwire.simulator.faults import (
    KINDS,
    Fault,
    Late,
    Lost,
    Scenario,
    ServoLeak,
    find,
    load,
    loads,
    shipped,
)
from cobotwire.simulator.faults.noise import NOISE
from field_notes.notes import ELSEWHERE, FIGURES, NOTES

HERE = Path(__file__).parent
BAD: list[dict[str, Any]] = YAML(typ="safe").load(HERE / "bad_scenarios.yaml")
GUIDE = vectors.ROOT / "docs" / "simulation.md"

# The scenario that reproduces each line of the field notes.
PRODUCED = {
    "leak": ("servo-leaks", "servo-leak-inside"),
    "leak packets": ("servo-leaks",),
    "leak FE": ("servo-checksum-fe",),
    "text": ("command-errors", "malformed-input"),
    "panic": ("panic",),
    "boot": ("panic", "nuls"),
    "merged": ("merged-acks", "merged-replies", "stray-acks"),
    "late": ("stall", "late-replies", "late-acks"),
    "baud": ("wrong-baud",),
    "echo": ("echo", "transponder"),
    "xon": ("flow-control",),
    "dtr": ("held-in-reset",),
    "again": ("lossy-line",),
    "flushing": ("late-replies",),
    "two writers": ("two-writers",),
    "no checksum": ("damaged-requests", "corrupted-replies"),
    "0x19": ("frozen",),
    "0x53": ("short-register-read",),
    "round trip": ("usb-latency-timer",),
    "line rate": ("slow-line",),
    "unanswered": ("no-acks", "held-in-reset"),
    "pause": ("pause-in-reply", "pause-after-header"),
    "other frame": ("other-frame-before-reply",),
    "split": ("pause-in-reply",),
    "vanished": ("unplugged",),
    "minus one": ("lossy-line",),
}


@pytest.mark.parametrize("case", BAD, ids=lambda case: str(case["name"]))
def test_bad_scenario_file_is_rejected_with_these_messages(
    case: dict[str, Any], tmp_path: Path
) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text(case["text"])
    with pytest.raises(ScenarioError) as caught:
        load(path, mycobot280.TABLE)
    reported = [problem.replace(f"{path}:", "bad.yaml:") for problem in caught.value.problems]
    assert [line.replace(str(tmp_path), "FOLDER") for line in reported] == case["problems"]


def test_scenario_file_is_read_into_its_faults() -> None:
    text = """
    about: |
      Two things
      go wrong.
    seed: 7
    faults:
      - {fault: late, commands: get_angles, nth: [1, 3], seconds: 0.25}
      - {fault: servo-leak, packets: [ping, read], probability: 0.5, until_seconds: 9}
    """
    late = Late(commands=("get_angles",), nth=(1, 3), seconds=0.25)
    leak = ServoLeak(packets=("ping", "read"), probability=0.5, until_seconds=9)
    expected = Scenario(name="two", about="Two things go wrong.", seed=7, faults=(late, leak))
    assert loads(text, "two", mycobot280.TABLE) == expected


GOOD = """about: All of it.
seed: 3
faults:
  - {fault: late, commands: [get_angles, 0x20], nth: [1, 2], seconds: 0.5}
  - &leak {fault: servo-leak, packets: [ping], only: replies}
  - fault: inserted
    data: "FE FE"
"""
PIECES = ["", ":", "- ", "{", "}", "[", "]", "&a", "*leak", "!!set ", "<<: *leak", "? ", "0x", "#"]
PIECES += ["\n", "\t", "'", '"', "---\n", "|", "1e999", "9" * 5000, "2001-01-01", "\x07", "\ud800"]


@given(
    st.lists(
        st.tuples(st.integers(0, len(GOOD)), st.integers(0, 9), st.sampled_from(PIECES)),
        min_size=1,
        max_size=3,
    )
)
def test_damaged_scenario_file_is_read_or_rejected_with_places(
    edits: list[tuple[int, int, str]],
) -> None:
    text = GOOD
    for at, size, piece in edits:
        text = text[:at] + piece + text[at + size :]
    problems: tuple[str, ...] | None = None
    try:
        loads(text, "spoilt", mycobot280.TABLE)
    except ScenarioError as error:
        problems = error.problems
    assert problems != ()
    for problem in problems or ():
        assert re.match(r"spoilt:\d+:\d+: ", problem), problem


def test_command_names_are_not_checked_without_a_table() -> None:
    scenario = loads("faults: [{fault: lost, commands: of_another_edition}]")
    assert scenario.faults == (Lost(commands=("of_another_edition",)),)


@pytest.mark.parametrize("name", shipped())
def test_shipped_scenarios_are_valid_in_each_edition(name: str) -> None:
    for table in (mycobot.TABLE, mycobot280.TABLE):
        scenario = find(name, table)
        assert scenario.name == name
        assert scenario.about.endswith(".")
        assert scenario.faults


def test_each_field_note_has_a_shipped_scenario() -> None:
    # Polling rates are not a fault, and pymycobot's rounding is not a fault of the line.
    assert set(NOTES) - set(PRODUCED) == {"polling", "truncated"} <= set(FIGURES) | set(ELSEWHERE)
    assert {name for names in PRODUCED.values() for name in names} <= set(shipped())


def test_unknown_scenario_name_is_rejected_with_the_nearest() -> None:
    with pytest.raises(UsageError, match="did you mean merged-acks"):
        find("merged-aks")
    with pytest.raises(UsageError, match="No such file"):
        find("./merged-acks")


def test_yaml_examples_of_the_guide_are_valid_scenarios() -> None:
    examples = re.findall(r"```yaml\n(.*?)```", GUIDE.read_text(), re.DOTALL)
    assert examples
    for example in examples:
        assert loads(example, "example", mycobot280.TABLE).faults


def test_python_examples_of_the_guide_run(capsys: pytest.CaptureFixture[str]) -> None:
    examples = re.findall(r"```python\n(.*?)```", GUIDE.read_text(), re.DOTALL)
    for example in examples:
        exec(compile(example, str(GUIDE), "exec"), {})
    printed = capsys.readouterr().out
    assert len(examples) == 3
    assert "b'\\xfe\\xfe\\x0e " in printed
    assert "Angles(j1=0.0" in printed


def test_guide_lists_every_fault_and_every_key() -> None:
    rows = dict(re.findall(r"^\| `([a-z-]+)` \|(.*)$", GUIDE.read_text(), re.MULTILINE))
    common = {field.name for field in fields(Fault)}
    for name, cls in KINDS.items():
        own = {field.name for field in fields(cls)} - common
        missing = {key for key in own if not re.search(rf"`{key}\b", rows[name])}
        assert not missing or "as `inserted`" in rows[name], (name, missing)
    assert {name for name in NOISE if f"`{name}`" not in rows["noise"]} == set()


def test_missing_yaml_library_error_names_the_package_to_install() -> None:
    script = (
        "import sys; sys.modules['ruamel'] = None; sys.modules['ruamel.yaml'] = None\n"
        "from cobotwire.simulator.faults import Late, Scenario, loads\n"
        "Scenario(name='objects need no YAML', faults=(Late(),))\n"
        "loads('faults: []')"
    )
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert "UsageError" in ended.stderr
    assert "pip install 'cobotwire[sim]'" in ended.stderr


def test_file_above_a_limit_is_refused() -> None:
    with pytest.raises(ScenarioError, match="scenario:1:1: the file has more than 1048576 char"):
        loads("# \n" * 400_000)
