"""Check that a version can be released. This script publishes nothing.

    python tools/release.py                # check this tree; print what is left to do
    python tools/release.py --build        # also build and check the distributions
    python tools/release.py --changelog    # move the fragments of news/ into CHANGELOG.md
    python tools/release.py --tag v0.1.0   # in the release workflow: also check that the tag fits
    python tools/release.py --notes        # print the changelog's section of the version

Pushing a tag starts .github/workflows/release.yml, which builds, waits for a maintainer's approval,
and publishes.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Callable, Iterator
from datetime import date
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
RECORDED = "tests/capture/recorded"
VERSION = re.compile(r"\d+\.\d+\.\d+(rc\d+)?")
DATE_FORMAT = re.compile(r"\d{4}-\d{2}-\d{2}")
LEFT = """
Left to do by hand, in this order:
  1. Confirm the repository's URL (pyproject.toml names {repository}) and the site's.
  2. Once: register .github/workflows/release.yml with the environment "pypi" as trusted publisher
     of the projects cobotwire, cobotwire-codegen and lerobot_robot_cobotwire on PyPI; require an
     approval in it.
  3. make test, make release-check, make wheels-check, make fuzz FUZZ_SECONDS=600, make conform
  4. git tag --sign v{version} && git push origin v{version}
  5. Read what the workflow built, then approve its job "publish".
  6. Install it as a user: pip install cobotwire=={version}; cobotwire demo
"""


class Failed(Exception):
    """A check failed; the text says what to do."""


def version(root: Path = ROOT) -> str:
    """Return the version that Cargo.toml states, for all parts."""
    stated: str = _toml("Cargo.toml", root)["workspace"]["package"]["version"]
    return stated


def check_version() -> str:
    """Check the version; tests/packages checks that every file states the same version."""
    number = version()
    if not VERSION.fullmatch(number):
        raise Failed(f"Cargo.toml: {number} is not a version such as 1.2.3 or 1.2.3rc1")
    return number


def check_changelog() -> str:
    """Check that the version has a dated section, and that no news is left out."""
    if left := [path.name for path in (ROOT / "news").iterdir() if path.name != "README.md"]:
        raise Failed(f"news/ has {left[0]}: run python tools/release.py --changelog")
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    found = re.search(rf"^## {re.escape(version())} \((.*)\)$", text, re.MULTILINE)
    if found is None:
        raise Failed(f"CHANGELOG.md has no section {version()}: add news, then use --changelog")
    if not DATE_FORMAT.fullmatch(found[1]):
        heading, dated = found[0], f"## {version()} ({date.today()})"
        raise Failed(f"CHANGELOG.md: {heading!r} has no date; on the day write {dated!r}")
    return f"{version()} of {found[1]}"


def check_recording() -> str:
    """Check that later releases will have a recording of this one to read."""
    path = f"{RECORDED}/{version()}.pcapng"
    if not (ROOT / path).exists():
        raise Failed(f"{path} is missing: cobotwire monitor URL --count 2 --record {path}")
    return path


def check_tree() -> str:
    """Check that everything is committed."""
    if changed := git("status", "--porcelain"):
        raise Failed(f"not committed: {changed.splitlines()[0]}")
    return git("rev-parse", "--short", "HEAD")


def check_branch() -> str:
    """Check that the commit is on main, and that the version has no tag yet."""
    if git("tag", "--list", f"v{version()}"):
        raise Failed(f"v{version()} exists: a version is released once; raise it in Cargo.toml")
    if (branch := git("rev-parse", "--abbrev-ref", "HEAD")) != "main":
        raise Failed(f"this is {branch}; releases are made from main: git switch main")
    return "main"


def check_ci() -> str:
    """Check that each workflow of this commit succeeded, as far as the command gh can tell."""
    if shutil.which("gh") is None:
        raise Failed(
            "the command gh is not installed: install it, or look at the commit's checks on GitHub"
        )
    command = ("gh", "run", "list", "--commit", git("rev-parse", "HEAD"))
    states = _run(*command, "--json", "name,conclusion", "--jq", '.[] | .name + ": " + .conclusion')
    if not states or any(not line.endswith(": success") for line in states.splitlines()):
        raise Failed(f"not every workflow succeeded: {states or 'none has run'}")
    return states.replace("\n", ", ")


def check_distributions() -> str:
    """Build the distributions; check metadata, contents and versions."""
    with tempfile.TemporaryDirectory() as folder:
        build(Path(folder))
        return check_files(Path(folder))


def check_files(folder: Path) -> str:
    """Check distributions that were built."""
    files = sorted(folder.iterdir())
    wrong = [file.name for file in files if f"-{version()}" not in file.name]
    if len(files) < 6 or wrong:
        raise Failed(f"expected three source distributions and wheels of {version()}: {files}")
    _run(sys.executable, "-m", "twine", "check", "--strict", *map(str, files))
    wheels = [str(file) for file in files if file.suffix == ".whl"]
    # W002: duplicate files. Editions of similar robots have modules with the same text.
    _run(sys.executable, "-m", "check_wheel_contents", "--ignore", "W002", *wheels)
    return ", ".join(file.name for file in files)


def build(folder: Path) -> None:
    """Build the source distributions, and from these the wheels."""
    python = sys.executable
    # The library of the studio's page, which is not committed.
    _run(python, str(ROOT / "tools" / "front_end.py"))
    _run(python, "-m", "maturin", "sdist", "--out", str(folder))
    [source] = folder.glob("cobotwire-*.tar.gz")
    command = ("pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", str(folder))
    _run(python, "-m", *command, str(source))
    for other in ("codegen", "adapters/lerobot"):
        _run(python, "-m", "build", "--outdir", str(folder), str(ROOT / other))


def notes() -> str:
    """Return the section of the changelog for this version."""
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    parts = re.split(r"^## (.*)$", text, flags=re.MULTILINE)
    for heading, body in zip(parts[1::2], parts[2::2]):
        if heading.split(" ")[0] == version():
            return body.strip()
    raise Failed(f"CHANGELOG.md has no section for {version()}")


def _toml(name: str, root: Path = ROOT) -> dict[str, Any]:
    return tomllib.loads((root / name).read_text(encoding="utf-8"))


def git(*words: str) -> str:
    """Return what git prints."""
    return _run("git", *words)


def _run(*words: str) -> str:
    # All files of a source distribution have the same date. So cargo would reuse the results of an
    # earlier one in a shared target folder.
    fresh = {name: value for name, value in os.environ.items() if name != "CARGO_TARGET_DIR"}
    ended = subprocess.run(words, cwd=ROOT, env=fresh, capture_output=True, text=True)  # noqa: S603
    if ended.returncode:
        raise Failed(f"{' '.join(words[:5])}: {ended.stderr.strip() or ended.stdout.strip()}")
    return ended.stdout.strip()


def _checks(tagged: bool, with_build: bool) -> Iterator[Callable[[], str]]:
    yield from (check_version, check_changelog, check_recording)
    if not tagged:
        yield from (check_tree, check_branch, check_ci)
    if with_build:
        yield check_distributions


def main() -> int:
    """Run the checks; return 1 if one failed."""
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--build", action="store_true", help="also build the distributions")
    parser.add_argument("--tag", help="the tag that starts the release")
    parser.add_argument("--changelog", action="store_true", help="move news/ into CHANGELOG.md")
    parser.add_argument("--notes", action="store_true", help="print the changelog's section")
    given = parser.parse_args()
    if given.notes:
        print(notes())
        return 0
    if given.changelog:
        print(_run(sys.executable, "-m", "towncrier", "build", "--yes", "--version", version()))
        return 0
    failed = 0
    for check in _checks(given.tag is not None, given.build):
        name = check.__name__.removeprefix("check_")
        try:
            print(f"ok    {name}: {check()}")
        except Failed as error:
            failed += 1
            print(f"FAIL  {name}: {error}")
    if given.tag not in (None, f"v{version()}"):
        failed += 1
        print(f"FAIL  tag: {given.tag} is not v{version()}")
    if given.tag is None:
        urls = _toml("pyproject.toml")["project"]["urls"]
        print(LEFT.format(version=version(), repository=urls["Repository"]))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
