"""Test the pytest plugin as other projects use it: installed, in separate pytest runs."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import vectors
from cobotwire.protocol.errors import UsageError
from cobotwire.simulator.testing.options import combined

INI = "[pytest]\naddopts = --strict-markers -q -p no:cacheprovider\nfilterwarnings = error\n"
GUIDE = (vectors.ROOT / "docs" / "testing.md").read_text()
EXAMPLES = re.findall(r"```python\n(.*?)```", GUIDE, re.DOTALL)


def run(folder: Path, *tests: str) -> str:
    """Run test files as a separate project; return what pytest printed."""
    (folder / "pytest.ini").write_text(INI)
    for number, test in enumerate(tests):
        (folder / f"test_it{number}.py").write_text(test)
    result = subprocess.run(
        [sys.executable, "-m", "pytest"],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    return result.stdout + result.stderr


def test_example_without_fixtures_runs(capsys: pytest.CaptureFixture[str]) -> None:
    exec(EXAMPLES[1], {})
    seconds = int(capsys.readouterr().out.split()[0])
    assert 11 < seconds < 16


PORTS = """
import pytest, serial, time

def ask(url):
    with serial.serial_for_url(url, 115200, timeout=60) as port:
        port.write(bytes.fromhex("FE FE 02 12 FA"))
        assert port.read(6) == bytes.fromhex("FE FE 03 12 00 FA")

def test_pty(simulated_arm_url):
    assert simulated_arm_url.startswith("/dev/")
    ask(simulated_arm_url)

@pytest.mark.simulated_arm(transport="tcp")
def test_tcp(simulated_arm_url):
    assert simulated_arm_url.startswith("socket://127.0.0.1:")
    ask(simulated_arm_url)

@pytest.mark.simulated_arm(transport="tcp", speed=100)
def test_a_client_over_tcp_in_faster_time(simulated_arm):
    simulated_arm.power_on()
    started = time.monotonic()
    simulated_arm.move_angles([100, 0, 0, 0, 0, 0], 5)
    assert time.monotonic() - started < 5
"""
MARKS = """
import pytest
from cobotwire import ReplyTimeout
from cobotwire.simulator.faults import Lost, Scenario

pytestmark = pytest.mark.simulated_arm(edition="mycobot280", scenario="sick.yaml")

def deaf(arm):
    with pytest.raises(ReplyTimeout):
        arm.get_angles()
    return type(arm).__name__

def test_mark_of_the_module(simulated_arm):
    assert deaf(simulated_arm) == "MyCobot280"

@pytest.mark.simulated_arm(edition="mycobot")
def test_own_mark_overrides_single_arguments(simulated_arm):
    assert deaf(simulated_arm) == "MyCobot"

@pytest.mark.simulated_arm(scenario=Scenario(name="own", faults=(Lost(),)), seed=3)
def test_scenario_as_an_object(simulated_arm):
    deaf(simulated_arm)

@pytest.mark.simulated_arm(scenario=None)
def test_no_scenario(simulated_arm):
    assert simulated_arm.is_power_on() is False
"""


def test_example_of_the_guide_ports_and_marks_work_in_another_project(tmp_path: Path) -> None:
    (tmp_path / "sick.yaml").write_text("faults:\n  - {fault: lost, only: replies}\n")
    # The example has 2 tests, PORTS 3, and MARKS, which reads the scenario file, 4.
    assert "9 passed" in (output := run(tmp_path, EXAMPLES[0], PORTS, MARKS)), output


WRONG: list[tuple[tuple[Any, ...], dict[str, Any], str]] = [
    (("mycobot280",), {}, "arguments by name"),
    ((), {"senario": "x"}, "did you mean scenario?"),
    ((), {"transport": "serial"}, "one of memory, pty, tcp"),
    ((), {"speed": 0}, "above 0"),
    ((), {"scenario": 3}, "an object with wrap()"),
]


@pytest.mark.parametrize(("places", "names", "message"), WRONG, ids=str)
def test_argument_that_a_mark_cannot_have_is_refused(
    places: tuple[Any, ...], names: dict[str, Any], message: str
) -> None:
    with pytest.raises(UsageError, match=re.escape(message)):
        combined([(places, names)], Path())


def test_wrong_mark_is_reported_as_an_error_of_its_test(tmp_path: Path) -> None:
    mark = (
        "@pytest.mark.simulated_arm(edition='mycobot28')\ndef test_it(simulated_arm):\n    pass\n"
    )
    printed = run(tmp_path, "import pytest\n" + mark)
    assert "1 error" in printed
    assert "did you mean mycobot280?" in printed


def test_run_without_the_fixtures_imports_only_the_plugins(tmp_path: Path) -> None:
    test = """
import sys

def test_it():
    loaded = set(sys.modules)
    ours = sorted(name for name in loaded if name.startswith("cobotwire"))
    assert ours == [
        "cobotwire",
        "cobotwire.conformance",
        "cobotwire.conformance.pytest_plugin",
        "cobotwire.conformance.report",
        "cobotwire.conformance.suite",
        "cobotwire.editions",
        "cobotwire.editions.clients",
        "cobotwire.protocol",
        "cobotwire.protocol.error_texts",
        "cobotwire.protocol.errors",
        "cobotwire.protocol.lazy",
        "cobotwire.protocol.printable",
        "cobotwire.simulator",
        "cobotwire.simulator.testing",
        "cobotwire.simulator.testing.plugin",
    ]
    assert not {"serial", "ruamel", "matplotlib", "numpy"} & loaded
"""
    assert "1 passed" in (output := run(tmp_path, test)), output
