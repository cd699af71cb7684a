"""Build the distributions, install them as a user does (without LeRobot), and run the docs.

    python tools/wheels_check.py [PYTHON ...]    # make wheels-check PYTHONS="python3.11 ..."

The wheels are built from the source distributions. Each Python gets a fresh environment without
Rust on its path: first with what `pip install cobotwire` installs, then with all extras.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path
from typing import NamedTuple

import release

ROOT = Path(__file__).parents[1]
TESTS = ROOT / "tests"
SYSTEM = "/usr/bin:/bin"
# What pages and tests use besides the wheels and their extras.
OTHERS = ("pytest", "hypothesis", "polars", "duckdb", "pandas", "s3fs", "dask", "numpy", "scipy")


class Part(NamedTuple):
    """A program that checks an installation: the arguments of Python, and a description."""

    what: str
    arguments: tuple[str | Path, ...]


_PYTEST = ("-m", "pytest", "-q", "-p", "no:cacheprovider", f"--rootdir={ROOT}")
# With only the wheels.
FIRST = Part("the first program of the README", (TESTS / "newcomer" / "first_program.py",))
# With all extras.
PARTS = (
    Part("README and website", (TESTS / "newcomer" / "run_pages.py",)),
    Part(
        "the call and its result at the top of each command's reference; the longer examples",
        (*_PYTEST, TESTS / "codegen/test_reference_examples.py", TESTS / "examples"),
    ),
    Part(
        "the protocols of other devices",
        (ROOT / "tools" / "wheels_protocols.py", TESTS / "protocols"),
    ),
)


def main() -> int:
    """Check each Python; return 1 if one fails."""
    parser = argparse.ArgumentParser(description="Run README and website from distributions.")
    parser.add_argument("pythons", nargs="*", default=[sys.executable], metavar="PYTHON")
    parser.add_argument("--dist", type=Path, help="distributions that were built before")
    given = parser.parse_args()
    pythons, built = given.pythons, given.dist
    failed = []
    with tempfile.TemporaryDirectory(prefix="cobotwire-wheels-") as name:
        if built is None:
            built = Path(name) / "dist"
            built.mkdir()
            release.build(built)
        print("built and checked:", release.check_files(built), flush=True)
        for number, python in enumerate(pythons):
            failed += _failures(python, built.resolve(), Path(name) / f"python{number}")
    print("\n".join(f"failed: {each}" for each in failed) or "everything is as it should be")
    return 1 if failed else 0


def _failures(python: str, built: Path, folder: Path) -> list[str]:
    """Install and run everything in a fresh environment of a Python; return what failed."""
    subprocess.run([python, "-m", "venv", str(folder)], check=True)  # noqa: S603
    here = folder / "bin" / "python"
    kept = {name: value for name, value in os.environ.items() if name in ("HOME", "LANG")}
    # The pages run `pip install cobotwire`; with these settings pip finds our wheels.
    environment = {
        **kept,
        "PATH": f"{here.parent}:{SYSTEM}",
        "PIP_FIND_LINKS": str(built),
        "PIP_DISABLE_PIP_VERSION_CHECK": "1",
    }

    def failed(what: str, *words: str | Path) -> list[str]:
        print(f"--- {python}: {what}", flush=True)
        start = time.monotonic()
        ended = subprocess.run(words, env=environment, cwd=folder)  # noqa: S603
        print(f"--- {time.monotonic() - start:.0f} s", flush=True)
        return [f"{python}: {what}"] if ended.returncode else []

    install = (here, "-m", "pip", "install", "--quiet")
    version = release.version()
    return (
        failed("install cobotwire", *install, f"cobotwire=={version}")
        or failed("cobotwire --version", "cobotwire", "--version")
        or failed(FIRST.what, here, *FIRST.arguments)
        or failed(
            "install all extras",
            *(*install, f"cobotwire[all]=={version}", f"cobotwire-codegen[all]=={version}"),
            *_pinned(OTHERS),
        )
        or failed("cobotwire-gen --version", "cobotwire-gen", "--version")
        or [each for part in PARTS for each in failed(part.what, here, *part.arguments)]
    )


def _pinned(names: tuple[str, ...]) -> list[str]:
    """Return what the tests require of these packages."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    group = tomllib.loads(text)["dependency-groups"]["test"]
    stated = [each for each in group if isinstance(each, str)]
    return [each for each in stated if each.partition("=")[0].rstrip(">").split("[")[0] in names]


if __name__ == "__main__":
    sys.exit(main())
