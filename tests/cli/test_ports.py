"""Run ``cobotwire ports`` with made-up serial ports."""

from __future__ import annotations

import json
import sys

import pytest
from click.testing import CliRunner

from cobotwire.cli.ports import ports
from cobotwire.transport.serial import ports as serial_ports
from cobotwire.transport.serial.ports import Port
from cobotwire.transport.serial.remedies import RULES_FILE

ARM = Port("/dev/ttyACM0", True, "CH9102, a bridge", True, "USB Single Serial", "1A86:55D4", "54")
CLOSED = Port("/dev/ttyUSB3", False, "no known adapter", False)


def run(monkeypatch: pytest.MonkeyPatch, found: list[Port], *words: str) -> tuple[int, str]:
    # Replace the ports of the machine, which are unknown.
    monkeypatch.setattr(serial_ports, "ports", lambda: found)
    result = CliRunner().invoke(ports, words)
    return result.exit_code, result.output


def test_likely_port_is_listed_with_the_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    code, output = run(monkeypatch, [ARM, CLOSED])
    assert code == 0
    lines = output.splitlines()
    assert lines[0].split() == ["/dev/ttyACM0", "likely", "CH9102,", "a", "bridge", "(1A86:55D4)"]
    assert lines[1].strip() == "USB Single Serial, serial number 54"
    assert lines[2].split()[:2] == ["/dev/ttyUSB3", "unlikely"]
    assert "you have no permission to open it" in lines[3]


def test_exit_code_is_1_without_a_likely_port(monkeypatch: pytest.MonkeyPatch) -> None:
    assert run(monkeypatch, [CLOSED])[0] == 1
    code, output = run(monkeypatch, [])
    assert code == 1
    assert "this computer has no serial port" in output
    assert "no arm was found: `cobotwire ports --fix` says" in output
    assert run(monkeypatch, [], "--fix")[1].startswith("needed    no arm was found: check that it")


def test_fix_prints_the_steps_for_this_system_and_changes_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(serial_ports, "programs_using", lambda device: "minicom (process 7)")
    code, output = run(monkeypatch, [CLOSED], "--fix")
    assert code == 1, "no port is likely"
    lines = output.splitlines()
    assert lines[0].split()[:3] == ["needed", "/dev/ttyUSB3:", "minicom"]
    assert f"sudo tee {RULES_FILE} <<'END'" in lines
    assert all(len(line) < 80 for line in lines if "ATTRS" not in line)
    steps = json.loads(run(monkeypatch, [ARM], "--fix", "--json")[1])
    assert steps["system"] == sys.platform
    assert [step["name"] for step in steps["remedies"]] == ["busy", "group", "udev", "brltty"]


def test_json_output_holds_every_attribute(monkeypatch: pytest.MonkeyPatch) -> None:
    code, output = run(monkeypatch, [ARM, CLOSED], "--json")
    assert code == 0
    assert [Port(**entry) for entry in json.loads(output)] == [ARM, CLOSED]
    assert json.loads(run(monkeypatch, [], "--json")[1]) == []
