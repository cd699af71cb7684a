"""The template on the page about custom targets runs and gives the output shown there."""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from cobotwire_codegen.cli import main
from strategies import TABLES, variants_of
from vectors import ROOT

PAGE = (ROOT / "docs" / "targets.md").read_text()
TEMPLATE, OUTPUT = re.findall(r"^```(?:jinja)?\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)


def _run(template: Path, *options: str, edition: str = "mycobot280") -> tuple[int, str]:
    file = str(ROOT / "spec" / "editions" / f"{edition}.yaml")
    result = CliRunner().invoke(main, ["render", str(template), file, *options])
    return result.exit_code, result.output


@pytest.fixture
def template(tmp_path: Path) -> Path:
    """Write the page's template to a file, as a reader does."""
    path = tmp_path / "commands.csv.j2"
    path.write_text(TEMPLATE)
    return path


def test_template_of_the_page_renders_the_output_of_the_page(template: Path) -> None:
    status, text = _run(template)
    assert status == 0
    assert text.startswith(OUTPUT)
    assert len(TEMPLATE.splitlines()) <= 30, "the page promises a short template"


@pytest.mark.parametrize("edition", sorted(TABLES))
def test_csv_has_a_line_for_every_variant(template: Path, edition: str, tmp_path: Path) -> None:
    out = tmp_path / "commands.csv"
    assert _run(template, "--out", str(out), edition=edition) == (0, "")
    lines = list(csv.DictReader(io.StringIO(out.read_text())))
    found = {
        (line["command"], line["direction"], int(line["variant"])): (
            int(line["id"], 16),
            int(line["data bytes"]),
            line["fields"].split(),
        )
        for line in lines
    }
    right = {
        (variant.command.name, variant.direction, variant.number): (
            variant.command.id,
            variant.variant.size,
            [field.name for field in variant.variant.fields],
        )
        for variant in variants_of(TABLES[edition])
    }
    assert found == right
    assert len(lines) == len(right)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("{{ edition.nonsense }}", "nonsense"),
        ("{% for command in edition.commands %}", "endfor"),
        ('{% include "missing.j2" %}', "missing.j2"),
    ],
)
def test_template_error_names_file_and_line(tmp_path: Path, line: str, message: str) -> None:
    path = tmp_path / "mine.j2"
    path.write_text(f"first line\n{line}\n")
    status, text = _run(path)
    assert status == 2
    assert message in text
    assert "mine.j2:2" in text or "mine.j2:3" in text
