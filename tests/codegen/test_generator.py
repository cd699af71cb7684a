"""``cobotwire-gen`` writes and checks generated files; ``make lint`` checks the committed ones."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import in_process
import vectors
from cobotwire_codegen.cli import main
from cobotwire_codegen.language.reference import language_page
from in_process import Ended

EDITIONS = ("mycobot", "mycobot280")
GENERATED = ("python/cobotwire/editions/mycobot", *(f"docs/reference/{name}" for name in EDITIONS))


def run(root: Path, *words: str) -> Ended:
    return in_process.run(main, "cobotwire-gen", "--root", str(root), *words)


def copy_spec(root: Path) -> None:
    """Copy two editions of the spec, one of them a delta; all of them would take minutes."""
    shutil.copytree(vectors.ROOT / "spec", root / "spec")
    for path in (root / "spec" / "editions").glob("*.yaml"):
        if path.stem not in EDITIONS:
            path.unlink()
    (root / "spec" / "pymycobot.yaml").unlink()  # it names other editions


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Copy the spec into a project without generated files."""
    copy_spec(tmp_path)
    return tmp_path


@pytest.fixture(scope="module")
def template(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Generate a project in another process; a test changes only a copy of it."""
    root = tmp_path_factory.mktemp("template")
    copy_spec(root)
    _generate(root, seed="1")
    return root


@pytest.fixture
def generated(template: Path, tmp_path: Path) -> Path:
    """Copy a project with its generated files."""
    return Path(shutil.copytree(template, tmp_path / "generated"))


def _generate(root: Path, seed: str) -> None:
    command = [sys.executable, "-m", "cobotwire_codegen", "--root", str(root)]
    environment = {**os.environ, "PYTHONHASHSEED": seed}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    assert done.returncode == 0, done.stderr


def _files(root: Path) -> dict[str, bytes]:
    paths = (p for folder in GENERATED for p in (root / folder).rglob("*") if p.is_file())
    found = (p for p in paths if "__pycache__" not in p.parts)
    return {str(path.relative_to(root)): path.read_bytes() for path in found}


def test_output_does_not_depend_on_the_hash_seed(project: Path, template: Path) -> None:
    _generate(project, seed="2")
    assert _files(project) == _files(template)
    assert len(_files(project)) > 30


def test_check_reports_each_wrong_file_and_the_generator_repairs_them(generated: Path) -> None:
    stale, missing = (generated / GENERATED[0] / name for name in ("values.py", "enums.py"))
    stale.write_text(stale.read_text().replace("class Angles", "class Angels"))
    missing.unlink()
    left_over = generated / GENERATED[0] / "messages" / "old.py"
    left_over.write_text("")
    other_line_ends = generated / "docs/reference/mycobot/README.md"
    other_line_ends.write_bytes(other_line_ends.read_bytes().replace(b"\n", b"\r\n"))
    before = _files(generated)
    result = run(generated, "--check")
    assert result.returncode == 1
    for line in (
        *(f"stale: {path}" for path in (stale, other_line_ends)),
        *(f"missing: {missing}", f"left over: {left_over}"),
        "-class Angels(NamedTuple):\n+class Angles(NamedTuple):",
        "4 generated file(s) are stale",
    ):
        assert line in result.stdout
    assert _files(generated) == before, "--check writes nothing"
    assert run(generated).returncode == 0
    assert not left_over.exists()
    assert "0 file(s) changed" in run(generated).stdout
    assert run(generated, "--check").stdout == "fresh\n"


def test_products_are_written_only_with_their_option(generated: Path) -> None:
    assert not (generated / "targets").exists()
    assert not (generated / "rust").exists()
    assert not (generated / "docs/_static").exists()
    assert run(generated, "--products").returncode == 0
    for product in ("c/mycobot280/mycobot280.h", "vectors/schema.json", "wireshark/mycobot.lua"):
        assert (generated / "targets" / product).stat().st_size > 1000
    assert (generated / "rust/client/src/editions/mycobot280.rs").exists()
    assert (generated / "docs/_static/decoder/editions/mycobot280.js").exists()
    assert (generated / "docs/reference/language.md").read_text() == language_page()
    (generated / "targets/wireshark/mycobot.lua").unlink()
    assert run(generated, "--check").returncode == 0
    assert run(generated, "--products", "--check").returncode == 1


def test_option_rust_data_writes_only_the_editions_of_the_rust_client(generated: Path) -> None:
    stale = generated / GENERATED[0] / "values.py"
    stale.write_text("")
    assert run(generated, "--rust-data", "--check").returncode == 1
    assert "5 file(s) changed" in run(generated, "--rust-data").stdout
    assert run(generated, "--rust-data", "--check").stdout == "fresh\n"
    for name in EDITIONS:
        assert (generated / f"rust/client/src/editions/{name}.rs").exists()
    assert not (generated / "targets").exists()
    assert stale.read_text() == ""
    assert run(generated, "--rust-data", "--products").returncode == 2


def test_generator_with_bad_spec_writes_nothing_and_exits_with_2(project: Path) -> None:
    path = project / "spec/commands/jog.yaml"
    path.write_text(path.read_text().replace("safety: motion", "safety: moton", 1))
    result = run(project)
    assert result.returncode == 2
    assert "did you mean motion?" in result.stderr
    assert "1 problem(s) in the spec" in result.stderr
    assert _files(project) == {}
