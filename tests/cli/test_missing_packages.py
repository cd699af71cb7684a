"""Check the packages that the command line needs, and the error if one is missing."""

from __future__ import annotations

import ast
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import vectors
from cobotwire.cli.app import app
from cobotwire.studio import extras
from in_process import run

CLI = vectors.ROOT / "python" / "cobotwire" / "cli"


def run_without(package: str, *words: str) -> subprocess.CompletedProcess[str]:
    """Run the command line as if a package was not installed."""
    script = (
        f"import sys; sys.modules[{package!r}] = None\n"
        "from cobotwire.cli import main\n"
        f"sys.argv[1:] = {list(words)!r}\n"
        "main()"
    )
    return subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=False
    )


def test_every_package_that_the_command_line_imports_is_a_dependency() -> None:
    project = tomllib.loads((vectors.ROOT / "pyproject.toml").read_text())["project"]
    installed = {words.split(">")[0] for words in project["dependencies"]}
    imported = {name for path in CLI.rglob("*.py") for name in _imported(path)}
    assert imported - set(sys.stdlib_module_names) - {"cobotwire"} <= installed
    assert {"click", "rich"} <= imported


def _imported(path: Path) -> set[str]:
    nodes = list(ast.walk(ast.parse(path.read_text())))
    names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    names |= {node.module for node in nodes if isinstance(node, ast.ImportFrom) and node.module}
    return {name.partition(".")[0] for name in names}


# newcomer/test_newcomer.py tests `plot`.
@pytest.mark.parametrize(
    ("package", "words", "sentence"),
    [
        ("rich", ["ports"], "the command line needs click and rich: pip install click rich"),
        ("click", ["ports"], "the command line needs click and rich: pip install click rich"),
        *(
            ("ruamel", words, "fault scenarios need ruamel.yaml: pip install 'cobotwire[sim]'")
            for words in (["sim", "--scenario", "panic"], ["sim", "--list-scenarios"])
        ),
        (
            "cyclonedds",
            ["ros2", "/dev/null"],
            "cobotwire ros2 needs cyclonedds: pip install 'cobotwire[ros2]'",
        ),
        ("mcp", ["mcp", "/dev/null"], "cobotwire mcp needs mcp: pip install 'cobotwire[mcp]'"),
        (
            "defusedxml",
            ["sim", "--geometry", __file__],
            f"{__file__}: reading a URDF needs defusedxml: pip install 'cobotwire[urdf]'",
        ),
        *(
            (
                package,
                ["studio", "--no-browser"],
                f"cobotwire studio needs {package}: pip install 'cobotwire[studio]'",
            )
            for package in ("starlette", "uvicorn")
        ),
    ],
)
def test_missing_package_is_named_in_one_sentence(
    package: str, words: list[str], sentence: str
) -> None:
    result = run_without(package, *words)
    assert result.returncode != 0
    assert result.stdout == ""
    assert result.stderr == f"cobotwire: {sentence}\n"


@pytest.mark.parametrize(
    ("package", "words", "extra"),
    [
        ("pyarrow", ["arm.bin"], "arrow"),
        ("mcap", ["arm.bin", "--as", "mcap"], "mcap"),
        ("fsspec", ["arm.bin", "memory://none"], "fsspec"),
        ("zstandard", ["arm.bin.zst"], "zstd"),
    ],
)
def test_export_names_the_extra_of_a_missing_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, package: str, words: list[str], extra: str
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("arm.bin", "arm.bin.zst"):
        Path(name).write_bytes(bytes.fromhex("FE FE 03 12 01 FA"))
    done = run_without(package, "export", *words, "-o", "out")
    assert done.returncode == 2
    assert f"needs {package}: pip install 'cobotwire[{extra}]'" in done.stderr


def test_studio_of_a_build_without_its_page_is_hidden_and_says_why(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    assert " studio " in run(app, "cobotwire", "--help").stdout or not extras.CURVES.is_file()
    monkeypatch.setattr(extras, "CURVES", tmp_path / "uPlot.iife.min.js")
    assert " studio " not in run(app, "cobotwire", "--help").stdout
    refused = run(app, "cobotwire", "studio", "--no-browser")
    assert refused.returncode == 2
    assert refused.stderr.startswith("cobotwire: cobotwire studio needs uPlot, which was left out")
