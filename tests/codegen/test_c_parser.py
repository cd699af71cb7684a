"""If the C parser gives a result, the parser in Python gives the same."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode

from cobotwire_codegen.c_parser import c_library, plain_root
from cobotwire_codegen.load import DEEPEST, loaded
from vectors import ROOT

SPECS = sorted((ROOT / "spec").rglob("*.yaml"))
# The styles of real specs, for tests that change them: flow, block, quotes, folded texts, comments.
SAMPLE = """\
# a command
commands:
  send_angle: {id: 0x21, safety: motion, note: "joint 1: 'base'", limits: [-168.0, 168.0]}
  get_angles:
    id: 0x20
    note: >-
      Read the angles:
      all of them.
    reply:
    - {name: angles, type: angle, count: 6}
    - name: ok
      type: bool
      const: true
    empty:
    old: ~
    date: 2020-01-01
"""


def _content(node: Node | None) -> Any:
    """Return what the generator reads from a node: kind, tag, place, content."""
    if node is None:
        return None
    place = (node.start_mark.line, node.start_mark.column)
    if isinstance(node, ScalarNode):
        return ("scalar", str(node.tag), place, node.value)
    if isinstance(node, MappingNode):
        return ("mapping", place, [(_content(key), _content(value)) for key, value in node.value])
    return ("sequence", place, [_content(item) for item in node.value])


def _in_python(text: str) -> Any:
    try:
        return _content(YAML(typ="safe", pure=True).compose(text))
    except YAMLError as error:
        return f"rejected: {error}"


def _agree(text: str) -> bool:
    """Compare both parsers; return whether the C parser gave a result."""
    root = plain_root(text, DEEPEST)
    if root is None:
        return False
    assert _content(root) == _in_python(text)
    return True


def test_c_parser_is_installed_for_the_tests() -> None:
    assert c_library is not None


@pytest.mark.parametrize("path", SPECS[::10], ids=lambda path: path.stem)
def test_c_parser_reads_spec_files_as_the_parser_in_python(path: Path) -> None:
    _agree(path.read_text(encoding="utf-8"))


def test_most_spec_files_are_plain() -> None:
    plain = [plain_root(path.read_text(encoding="utf-8"), DEEPEST) is not None for path in SPECS]
    assert sum(plain) > 0.95 * len(SPECS)


@st.composite
def changed_samples(draw: st.DrawFn) -> str:
    """Draw the sample with some pieces replaced by characters that have a meaning in YAML."""
    text = SAMPLE
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.integers(0, 3)))
        piece = draw(
            st.text(
                "{}[],:-?#&*!|>'\"%@`~=< \n\t\r\\0x1.eE_aäé\x85\u2028\x00\U0001f600", max_size=4
            )
        )
        text = text[:start] + piece + text[end:]
    return text


@given(changed_samples())
def test_c_parser_agrees_or_gives_nothing(text: str) -> None:
    _agree(text)


@given(st.text("{}[],:-?#|>'\"%~=< \n0x1.e_aä", max_size=30))
def test_c_parser_agrees_on_any_text_of_special_characters(text: str) -> None:
    _agree(text)


@pytest.mark.parametrize(
    "text",
    [
        "a: &x 1",
        "a: *x",
        "a: !!str 1",
        "%YAML 1.1\n---\na: 012",
        "a: 1\n---\nb: 2",
        "a: [",
        "\ta: 1",
    ],
)
def test_text_that_is_not_plain_is_left_to_the_parser_in_python(text: str) -> None:
    assert plain_root(text, DEEPEST) is None


def test_deep_nesting_is_left_to_the_parser_in_python() -> None:
    assert plain_root("- " * 500_000, DEEPEST) is None
    assert plain_root("[" * 500_000, DEEPEST) is None


def test_without_the_c_parser_specs_read_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    path = ROOT / "spec" / "types.yaml"
    quick = loaded(path)
    monkeypatch.setattr("cobotwire_codegen.c_parser.c_library", None)
    assert loaded(path, "in Python").nodes == quick.nodes
