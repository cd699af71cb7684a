"""Build both distributions, install them as a user does, and run each command of the README there.

    python tools/wheels_check.py [PYTHON ...]    # make wheels-check PYTHONS="python3.11 ..."

The wheels are built from the source distributions. Each Python gets a fresh environment without
Rust on its path.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import release

ROOT = Path(__file__).parents[1]
RUNNER = ROOT / "tests" / "newcomer" / "run_readme.py"
SYSTEM = "/usr/bin:/bin"


def main() -> int:
    """Check each Python; return 1 if one fails."""
    parser = argparse.ArgumentParser(description="Run the README from built distributions.")
    parser.add_argument("pythons", nargs="*", default=[sys.executable], metavar="PYTHON")
    parser.add_argument("--dist", type=Path, help="distributions that were built before")
    given = parser.parse_args()
    pythons, built = given.pythons, given.dist
    failed = 0
    with tempfile.TemporaryDirectory(prefix="cobotwire-wheels-") as name:
        if built is None:
            built = Path(name) / "dist"
            built.mkdir()
            release.build(built)
        print("built and checked:", release.check_files(built), flush=True)
        for number, python in enumerate(pythons):
            print(f"--- {python}", flush=True)
            failed += not _check(python, built, Path(name) / f"python{number}")
    return 1 if failed else 0


def _check(python: str, built: Path, folder: Path) -> bool:
    """Return whether everything works in a fresh environment of a Python."""
    subprocess.run([python, "-m", "venv", str(folder)], check=True)  # noqa: S603
    programs = folder / "bin"
    kept = {name: value for name, value in os.environ.items() if name in ("HOME", "LANG")}
    environment = {**kept, "PATH": f"{programs}:{SYSTEM}"}

    def run(*words: str | Path) -> bool:
        return not subprocess.run(words, env=environment, cwd=folder).returncode  # noqa: S603

    [native] = built.glob("cobotwire-*.whl")
    [generator] = built.glob("cobotwire_codegen-*.whl")
    install = (programs / "python", "-m", "pip", "install", "--quiet")
    return (
        run(*install, f"{native}[all]", generator)
        and run("cobotwire", "--version")
        and run("cobotwire-gen", "--version")
        and run(programs / "python", RUNNER, ROOT / "README.md")
    )


if __name__ == "__main__":
    sys.exit(main())
