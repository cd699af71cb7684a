"""Build the source distribution as pip does: with the studio's page, or with a warning."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tarfile
import tomllib
from pathlib import Path

import pytest

import front_end
from vectors import ROOT

PARTS = ("LICENSE", "README.md", "Cargo.toml", "Cargo.lock", "pyproject.toml")
PAGE = "python/cobotwire/studio/page/vendor/"
NO_REGISTRY = "http://127.0.0.1:1"


@pytest.mark.parametrize("fetched", [True, False], ids=["fetched before", "registry not reachable"])
def test_source_distribution_has_the_page_or_the_build_warns(tmp_path: Path, fetched: bool) -> None:
    clone = tmp_path / "clone"
    ignored = shutil.ignore_patterns("target", "vendor", "*.so", "__pycache__", "corpus")
    for folder in ("python", "rust", "spec", "tools"):
        shutil.copytree(ROOT / folder, clone / folder, symlinks=True, ignore=ignored)
    for name in PARTS:
        shutil.copy(ROOT / name, clone / name)
    (clone / "spec/schema.json").touch()  # git ignores it
    if fetched:
        _fetched(clone)
    system = tomllib.loads((clone / "pyproject.toml").read_text())["build-system"]
    script = f"import {system['build-backend']} as backend; backend.build_sdist({str(tmp_path)!r})"
    # pip puts the folders of `backend-path` before all others, and its environment on the path.
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    ended = subprocess.run(
        [sys.executable, "-c", script],
        cwd=clone,
        env={
            **os.environ,
            "PATH": path,
            "PYTHONPATH": str(clone / system["backend-path"][0]),
            "NPM_CONFIG_REGISTRY": NO_REGISTRY,
        },
        capture_output=True,
        text=True,
    )
    assert ended.returncode == 0, ended.stderr
    [archive] = tmp_path.glob("*.tar.gz")
    with tarfile.open(archive) as opened:
        names = {name.partition("/")[2] for name in opened.getnames()}
    # A wheel is built from it by the same backend.
    assert {"tools/build_backend.py", "tools/front_end.py"} <= names
    assert "python/cobotwire/spec/frame.yaml" in names
    assert [name for name in names if name.endswith("schema.json")] == []
    assert any(name.startswith(PAGE) for name in names) is fetched
    warning = f"warning: the package is built without `cobotwire studio`, because {NO_REGISTRY}/"
    assert (warning in ended.stderr) is not fetched


def _fetched(clone: Path) -> None:
    """Make the files that a fetch writes; only the page needs their contents."""
    for package in front_end.PACKAGES:
        if package.shipped:
            stamp = clone / package.stamp.relative_to(ROOT)
            stamp.parent.mkdir(parents=True)
            stamp.write_text(f"{package.version}\n")
            for _, name in package.files:
                (clone / name).write_text("// uPlot\n")
