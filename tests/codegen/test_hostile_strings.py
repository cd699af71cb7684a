"""Hostile strings of a spec are refused at their place, or stay text in every output."""

from __future__ import annotations

import ast
import json
import re
import shutil
import subprocess
from pathlib import Path, PurePosixPath
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.language.edition import FILES
from cobotwire_codegen.language.records import Choice
from cobotwire_codegen.language.schema import records
from cobotwire_codegen.language.shapes import Text, Texts
from cobotwire_codegen.legal import odd_character
from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import render_python, render_reference
from cobotwire_codegen.targets.c import render_c
from cobotwire_codegen.targets.decoder import render_decoder
from cobotwire_codegen.targets.wireshark import render_wireshark
from codegen import hostile

SPEC = hostile.spec()
SLOTS = list(hostile.slots(SPEC))
# Texts that name something, or that have a grammar of their own.
REFERENCES = {"after", "change", "fact", "remove", "rename", "length_counts", "commands", "text"}
C_TEXT = re.compile(r'/\*.*?\*/|"(?:\\.|[^"\\\n])*"|//[^\n]*', re.DOTALL)
LUA_TEXT = re.compile(r'"(?:\\.|[^"\\\n])*"|--[^\n]*')


def _edition(whole: dict[str, Any], folder: Path) -> Edition:
    path = folder / "lamp.yaml"
    path.write_text(hostile.as_yaml(whole))
    edition = build_edition(path, folder)
    check(edition)
    return edition


def _outputs(edition: Edition) -> dict[str, str]:
    made = dict(render_python(edition))
    made |= {PurePosixPath("docs", name): text for name, text in render_reference(edition).items()}
    made |= render_c(edition) | render_wireshark([edition]) | render_decoder([edition])
    return {str(name): text for name, text in made.items()}


def _validate(files: dict[str, str]) -> None:
    for name, text in files.items():
        assert odd_character(text) == "", name
        if Path(name).suffix in VALIDATORS:
            VALIDATORS[Path(name).suffix](text)


def _validate_python(text: str) -> None:
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, ast.Constant):
            words = [word for word in vars(node).values() if isinstance(word, str)]
            assert not any("EVIL" in word for word in words)
    compile(text, "generated", "exec")


def _validate_c(text: str) -> None:
    assert "EVIL" not in C_TEXT.sub("", text).upper()


def _validate_lua(text: str) -> None:
    assert "EVIL" not in LUA_TEXT.sub("", text)


def _validate_markdown(text: str) -> None:
    assert "<script" not in text.lower()
    assert not re.search(r"(?<!\\)\]\(javascript", text)
    columns = 0
    for line in text.splitlines():
        found = len(re.findall(r"(?<!\\)\|", line)) if line.startswith("|") else 0
        assert found in (columns, 0) or columns == 0, line
        columns = found


def _validate_json(text: str) -> None:
    json.loads(text)


VALIDATORS = {
    ".py": _validate_python,
    ".c": _validate_c,
    ".h": _validate_c,
    ".lua": _validate_lua,
    ".md": _validate_markdown,
    ".json": _validate_json,
}


def _prose() -> set[str]:
    """Return the keys of the language that hold free text."""
    found = (record for record in records(FILES.values()) if not isinstance(record, Choice))
    keys = (key for record in found for key in record.keys().values())
    return {key.name for key in keys if type(key.shape) in (Text, Texts)} - REFERENCES


def _all_prose_replaced(payloads: list[str]) -> dict[str, Any]:
    """Return the spec with a payload in every free text; a number in each makes them unique."""
    prose, whole = _prose(), SPEC
    for number, (path, is_key) in enumerate(SLOTS):
        key = next(step for step in reversed(path) if isinstance(step, str))
        within = {"name": "vectors", "source": "evidence"}.get(key, key)
        if is_key or key not in prose or within not in path or "values" in path:
            continue
        payload = f"{payloads[number % len(payloads)]} {number}"
        whole = hostile.replaced(whole, path, False, payload[number % 2 * 4 :])
    return whole


@pytest.fixture(scope="module")
def attacked(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Return all outputs of a spec with a legal payload in every free text."""
    folder = tmp_path_factory.mktemp("attacked")
    legal = [p for p in hostile.PAYLOADS if not odd_character(p)]
    return _outputs(_edition(_all_prose_replaced(legal), folder))


def test_free_text_stays_text_in_every_output(attacked: dict[str, str]) -> None:
    _validate(attacked)
    assert {Path(name).suffix for name in attacked} >= set(VALIDATORS)


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc is not installed")
def test_attacked_c_compiles_without_a_warning(attacked: dict[str, str], tmp_path: Path) -> None:
    for name in ("lamp.c", "lamp.h"):
        (tmp_path / name).write_text(attacked[name])
    flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-trigraphs"]
    result = subprocess.run(
        ["gcc", *flags, "-DLAMP_NAMES", "lamp.c"], capture_output=True, check=False, cwd=tmp_path
    )
    assert result.stderr.decode() == ""


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
def test_attacked_table_of_the_decoder_page_is_a_script(
    attacked: dict[str, str], tmp_path: Path
) -> None:
    (tmp_path / "lamp.js").write_text(attacked["lamp.js"])
    assert subprocess.run(["node", "--check", "lamp.js"], cwd=tmp_path, check=False).returncode == 0


@settings(
    max_examples=25,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(st.sampled_from(SLOTS), st.sampled_from(hostile.PAYLOADS), st.booleans())
def test_hostile_string_is_refused_at_its_place_or_stays_text(
    tmp_path: Path, slot: tuple[tuple[str | int, ...], bool], payload: str, everywhere: bool
) -> None:
    path, is_key = slot
    whole = hostile.replaced(SPEC, path, is_key, payload)
    if everywhere and isinstance(path[-1], str):
        whole = hostile.renamed(SPEC, path[-1], payload)
    try:
        edition = _edition(whole, tmp_path)
    except SpecError as error:
        for problem in error.problems:
            assert str(problem).isprintable()
            assert re.match(r"lamp\.yaml:\d+:\d+: [a-z-]+: ", str(problem))
        return
    _validate(_outputs(edition))
