"""``cobotwire ports``."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner

from cobotwire.cli import ports as verb
from cobotwire.transport.serial.ports import Port

ARM = Port("/dev/ttyACM0", True, "CH9102, a bridge", True, "USB Single Serial", "1A86:55D4", "54")
SHUT = Port("/dev/ttyUSB3", False, "nothing speaks for it", False)


def run(monkeypatch: pytest.MonkeyPatch, found: list[Port], *words: str) -> tuple[int, str]:
    # What ports a machine has, no test can say.
    monkeypatch.setattr(verb, "ports", lambda: found)
    result = CliRunner().invoke(verb.ports_, words)
    return result.exit_code, result.output


def test_a_likely_port_is_told_with_the_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    code, said = run(monkeypatch, [ARM, SHUT])
    assert code == 0
    lines = said.splitlines()
    assert lines[0].split() == ["/dev/ttyACM0", "likely", "CH9102,", "a", "bridge", "(1A86:55D4)"]
    assert lines[1].strip() == "USB Single Serial, serial number 54"
    assert lines[2].split()[:2] == ["/dev/ttyUSB3", "unlikely"]
    assert "you may not open it" in lines[3]


def test_without_a_likely_port_the_answer_is_no(monkeypatch: pytest.MonkeyPatch) -> None:
    assert run(monkeypatch, [SHUT])[0] == 1
    code, said = run(monkeypatch, [])
    assert code == 1
    assert "is the arm's cable plugged in" in said


def test_json_says_all_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    code, said = run(monkeypatch, [ARM, SHUT], "--json")
    assert code == 0
    assert [Port(**entry) for entry in json.loads(said)] == [ARM, SHUT]
    assert json.loads(run(monkeypatch, [], "--json")[1]) == []
