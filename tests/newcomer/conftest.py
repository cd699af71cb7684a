"""Build both wheels once, and install them into a fresh environment without Rust."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

import vectors
from newcomer.installing import run


@pytest.fixture(scope="session")
def wheels(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Build both distributions as a release builds them."""
    folder = tmp_path_factory.mktemp("wheels")
    build = (sys.executable, "-m", "maturin", "build", "--release", "--quiet", "--out", folder)
    run(*build, cwd=vectors.ROOT)
    pip = (sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", folder)
    run(*pip, vectors.ROOT / "codegen")
    return sorted(folder.glob("*.whl"))


@pytest.fixture(scope="session")
def fresh(tmp_path_factory: pytest.TempPathFactory, wheels: list[Path]) -> Path:
    """Install the two wheels into a fresh environment, and return the folder of its programs."""
    folder = tmp_path_factory.mktemp("fresh") / "venv"
    # The pip of this process installs into the fresh environment: a pip there takes four seconds.
    run(sys.executable, "-m", "venv", "--without-pip", folder)
    [native] = [wheel for wheel in wheels if wheel.name.startswith("cobotwire-")]
    others = [wheel for wheel in wheels if wheel != native]
    # Python compiles what the tests import; pip would compile every edition.
    pip = (sys.executable, "-m", "pip", "--python", folder, "install", "--quiet", "--no-compile")
    run(*pip, native, *others)
    return folder / "bin"


@pytest.fixture
def environment(fresh: Path) -> dict[str, str]:
    """Return environment variables without Rust or this repository on the path."""
    kept = {name: value for name, value in os.environ.items() if name in ("HOME", "LANG")}
    return {**kept, "PATH": f"{fresh}:/usr/bin:/bin"}
