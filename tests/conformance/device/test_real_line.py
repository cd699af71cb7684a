"""Run the tester on a real pseudo-terminal: the verb, Ctrl-C, the pytest plugin, the recipe."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from importlib.metadata import entry_points
from pathlib import Path

import pytest

import vectors
from cobotwire import editions
from cobotwire.conformance import Verdict
from cobotwire.conformance.device import DeviceConnection, Permissions, Tester
from cobotwire.conformance.reports import from_json
from cobotwire.simulator import PtyServer, SimulatedArm
from cobotwire.transport import open_transport
from command_line import started
from conformance.device.testing import prepared

TABLE = editions.load("mycobot280").TABLE
WORDS = ("--edition", "mycobot280", "conform", "device")
PLUGIN = ["-p", "cobotwire.conformance.pytest_plugin"]
INSTALLED = any(point.name == "cobotwire_conform" for point in entry_points(group="pytest11"))


def test_run_of_queries_takes_less_than_five_seconds() -> None:
    # Computing and waiting are counted separately, because the machine may be busy.
    with PtyServer(SimulatedArm(TABLE)) as server:
        transport = open_transport(server.url, TABLE.baudrate)
        began = time.process_time()
        report = Tester(DeviceConnection(transport), TABLE).run()
        works = time.process_time() - began
        transport.close()
    assert report.conforms, [r for r in report.results if r.verdict is Verdict.FAIL]
    stepped = prepared(TABLE, permissions=Permissions())
    stepped.run()
    assert works + stepped.connection.now < 5
    assert len(report.reply_seconds["get_angles"]) >= 3


def test_ctrl_c_stops_the_arm_restores_settings_and_writes_a_report(tmp_path: Path) -> None:
    arm = SimulatedArm(TABLE)
    file = tmp_path / "report.json"
    options = ["--allow", "motion,power,persistent-write", "--max-speed", "1"]
    options += ["--workspace", "-60:60", "--json", str(file)]
    limits = list(arm.state.minimum), list(arm.state.maximum)
    with PtyServer(arm) as server, started(*WORDS, server.url, *options) as run:
        until = time.monotonic() + 60
        while not arm.state.angles.moving(time.monotonic()) and time.monotonic() < until:
            time.sleep(0.05)
        assert arm.state.angles.moving(time.monotonic())
        run.send_signal(signal.SIGINT)
        _, output = run.communicate(timeout=60)
        assert not arm.state.angles.moving(time.monotonic())
    assert "stopped" in output
    report = from_json(file.read_text())
    assert not report.finished
    assert report.results
    assert run.returncode == 2
    assert (arm.state.minimum, arm.state.maximum) == limits


def test_plugin_without_a_device_is_a_usage_error(tmp_path: Path) -> None:
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    done = _pytest(tmp_path, str(tmp_path / "ttyNONE"))
    assert done.returncode == pytest.ExitCode.USAGE_ERROR
    assert "INTERNALERROR" not in done.stdout + done.stderr
    assert "ttyNONE: cannot be opened" in done.stderr


def test_plugin_fails_the_test_cases_that_the_device_fails(tmp_path: Path) -> None:
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    mycobot = editions.load("mycobot").TABLE
    with PtyServer(SimulatedArm(mycobot)) as server:
        done = _pytest(tmp_path, server.url, "-k", "get_error_information or is_power_on")
    assert done.returncode == 1
    assert "expected a reply within 500 ms" in done.stdout
    assert re.search(r"[1-9]\d* passed", done.stdout)


def _pytest(folder: Path, url: str, *words: str) -> subprocess.CompletedProcess[str]:
    plugin = [] if INSTALLED else PLUGIN
    options = ["--conform-device", url, "--conform-edition", "mycobot280", *words]
    command = [sys.executable, "-m", "pytest", *plugin, *options, "."]
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)


# The first command runs the verb; the second runs each test case and command as a pytest test.
@pytest.mark.parametrize("number", range(2))
def test_commands_of_the_recipe_work(number: int, tmp_path: Path) -> None:
    page = (vectors.ROOT / "docs" / "conformance.md").read_text()
    blocks = [part.split("```", 1)[0] for part in page.split("```yaml")[1:]]
    [recipe] = [block for block in blocks if "run: " in block]
    commands = [line.split("run: ", 1)[1] for line in recipe.splitlines() if "run: " in line]
    ours = [command for command in commands if not command.startswith("pip ")]
    assert len(ours) == 2
    # The document's edition has half the commands, and the run is in real time.
    words = ours[number].replace("mycobot280", "mycobot")
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    with PtyServer(SimulatedArm(editions.load("mycobot").TABLE)) as server:
        environment = {**os.environ, "PATH": path, "DEVICE": server.url}
        if not INSTALLED:
            words = words.replace("pytest ", "pytest -p cobotwire.conformance.pytest_plugin ")
        done = subprocess.run(
            ["bash", "-ec", words],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
    assert done.returncode == 0, done.stdout + done.stderr
    written = "".join(file.read_text() for file in tmp_path.glob("conformance.*"))
    assert "get_angles" in written
    assert written.count("reply-once") > 20
