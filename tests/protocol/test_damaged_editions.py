"""A package whose ``edition.json`` is damaged is not loaded, and one error names the file."""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from typing import Any

import pytest

from cobotwire import editions
from cobotwire.cli.app import app
from cobotwire.protocol.damage import KINDS
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.loading import load_sources
from in_process import run

SHIPPED = Path(editions.__file__).parent
BUS = SHIPPED.parent / "diagnose" / "servo_bus" / "edition.json"
# FULL=1 damages every value, and takes minutes.
SAMPLED = 10**9 if os.environ.get("FULL") else 40
# What takes the place of a value.
VALUES: tuple[Any, ...] = (None, True, -1, 10**30, 1e300, "", "x", "\ud800", [], [[]], {}, {"x": 1})
# What happens to the whole file, and what the error says.
FILES: dict[str, tuple[Callable[[bytes], bytes], str]] = {
    "empty": (lambda data: b"", "it is not JSON: Expecting value in line 1, column 1"),
    "cut": (lambda data: data[: len(data) // 2], "it is not JSON: "),
    "not UTF-8": (lambda data: data[:99] + b"\xff" + data[99:], "byte 99 is 0xff"),
    "nested": (lambda data: b"[" * 200_000, "nested too deeply"),
    "a number of 5,000 digits": (
        lambda data: data.replace(b'"version": 3', b'"version": ' + b"9" * 5000),
        "Exceeds the limit",
    ),
    "not a number": (
        lambda data: data.replace(b'"version": 3', b'"joints": NaN'),
        "$.joints is a number; allowed: an integer",
    ),
    "a list": (lambda data: b"[]", "$ is a list; allowed: an object"),
    "one digit": (lambda data: data.replace(b'"id": 32', b'"id": 33', 1), "legal type"),
    "a space": (lambda data: data + b" ", "legal type"),
}


@pytest.fixture(scope="module", params=["mycobot", "mercury_a1"])
def package(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Path]:
    """The copy of a package; a user's own package is loaded in the same way."""
    folder = tmp_path_factory.mktemp("own") / f"own_{request.param}"
    shutil.copytree(SHIPPED / request.param, folder)
    yield folder
    sys.modules.pop(folder.name, None)


def _error(folder: Path, data: bytes) -> str:
    """Return the error of loading a package with another ``edition.json``."""
    file = folder / "edition.json"
    intact = file.read_bytes()
    for name in [each for each in sys.modules if each.split(".")[0] == folder.name]:
        del sys.modules[name]
    file.write_bytes(data)
    try:
        with pytest.raises(UsageError) as raised:
            editions.load(str(folder))
    finally:
        file.write_bytes(intact)
    assert raised.value.argument == "edition"
    text = str(raised.value)
    assert text.startswith(f"{file}: "), text
    assert "\n" not in text
    return text


@pytest.mark.parametrize("damage", FILES)
def test_damaged_file_is_refused_with_its_reason(package: Path, damage: str) -> None:
    change, reason = FILES[damage]
    assert reason in _error(package, change((package / "edition.json").read_bytes()))


def _nodes(value: Any, path: str = "$") -> Iterator[tuple[Any, Any, str]]:
    """Yield each object or list with each of its keys or indices, and the path of the value."""
    pairs = value.items() if isinstance(value, dict) else enumerate(value)
    for key, each in pairs:
        here = f"{path}.{key}" if isinstance(value, dict) else f"{path}[{key}]"
        yield value, key, here
        if isinstance(each, dict | list):
            yield from _nodes(each, here)


def _sample(draw: Random, nodes: list[Any]) -> list[Any]:
    return draw.sample(nodes, min(SAMPLED, len(nodes)))


def test_every_damaged_value_is_refused_and_named(package: Path) -> None:
    document = json.loads((package / "edition.json").read_bytes())
    draw = Random(1)
    for parent, key, path in _sample(draw, list(_nodes(document))):
        kept, value = parent[key], draw.choice(VALUES)
        if value == kept and type(value) is type(kept):
            continue
        parent[key] = value
        text = _error(package, json.dumps(document).encode())
        if key in KINDS and not re.search(r"\.(state|effect)\.", path):
            kind = KINDS[key]
            if not isinstance(value, kind) or (value is True and kind is int):
                assert f": {path} is " in text, text
        parent[key] = kept


def test_every_missing_key_is_refused_and_named_where_the_table_needs_it(package: Path) -> None:
    document = json.loads((package / "edition.json").read_bytes())
    keyed = [node for node in _nodes(document) if isinstance(node[0], dict)]
    named = 0
    for parent, key, path in _sample(Random(2), keyed):
        kept = dict(parent)
        del parent[key]
        text = _error(package, json.dumps(document).encode())
        named += f": {path} is missing" in text
        needed = key in ("id", "safety", "kind", "wires", "deadline_ms", "header")
        if needed and ".state." not in path:
            assert f": {path} is missing" in text, text
        parent.clear()
        parent.update(kept)
    assert named > 5


def test_kinds_of_values_are_those_of_every_shipped_edition() -> None:
    used = set()
    for file in [*SHIPPED.glob("*/edition.json"), BUS]:
        for parent, key, path in _nodes(json.loads(file.read_bytes())):
            if isinstance(key, str) and not re.search(r"\.(state|effect)\.", path) and key in KINDS:
                used.add(key)
                assert isinstance(parent[key], KINDS[key]), (file, path)
    assert used == set(KINDS)


@pytest.mark.parametrize("missing", ["edition.json", "table.py", "client.py"])
def test_package_that_lacks_a_file_is_refused_with_its_name(package: Path, missing: str) -> None:
    other = package.parent / f"{package.name}_without_{missing.partition('.')[0]}"
    shutil.copytree(package, other)
    (other / missing).unlink()
    with pytest.raises(UsageError, match=missing.partition(".")[0]):
        editions.load(str(other))


@pytest.mark.parametrize("codec", ["native", "reference"])
def test_command_line_reports_a_damaged_edition_in_one_line(
    package: Path, codec: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COBOTWIRE_CODEC", codec)
    other = package.parent / f"{package.name}_{codec}"
    shutil.copytree(package, other)
    (other / "edition.json").write_bytes(b"{}")
    ended = run(app, "cobotwire", "--edition", str(other), "decode", "FE FE 02 20 FA")
    assert (ended.returncode, ended.stdout) == (2, "")
    assert ended.stderr.startswith(f"cobotwire: {other}/edition.json: $.edition is missing; ")
    assert len(ended.stderr.splitlines()) == 1


@pytest.mark.parametrize("text", ["", "[]", "{}", "[" * 100_000, '{"errata": [{"commands": 1}]}'])
def test_damaged_errata_are_refused(package: Path, text: str) -> None:
    other = package.parent / f"{package.name}_errata_{abs(hash(text))}"
    shutil.copytree(package, other)
    editions.load(str(other))
    (other / "errata.json").write_text(text)
    with pytest.raises(UsageError, match=r"errata\.json is damaged; generate"):
        load_sources(other.name)


def test_sources_state_the_errata_of_a_command() -> None:
    editions.load("mycobot")
    found = load_sources("cobotwire.editions.mycobot")["get_angles"]
    assert found["place"].startswith("spec/commands/motion.yaml:")
    assert found["lines"] == [[223, 269]]
    assert len(found["errata"]) == 2
    assert all("get_angles" in each["commands"] for each in found["errata"])
    assert load_sources("cobotwire.editions.nothing") == {}
