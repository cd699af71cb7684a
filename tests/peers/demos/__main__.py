"""``make demos``: print how the maker's demos run; exit 1 if one runs only with the library."""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from fnmatch import fnmatch
from pathlib import Path
from typing import NamedTuple

from cobotwire.pymycobot.migrate import migrate
from demos.running import RUNS, WITH_LAYER, WITH_LIBRARY, outcome
from demos.scripts import COMMIT, DEMOS, FOLDERS, NOT_RUN, REPOSITORY, Demo

HEADING = (
    "| demo | with the library | with our layer | rewritten | to decide |\n|---|---|---|---|--:|"
)
OTHERS = "| not run | programs | why |\n|---|--:|---|"


class Folders(NamedTuple):
    """Copies of the repository: one for each way to run a demo."""

    library: Path
    layer: Path
    rewritten: Path


def main() -> int:
    """Fetch the demos, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repository", default=REPOSITORY, help="where to clone the demos from")
    parser.add_argument("--only", default="*", help="a pattern of the demos to run")
    given = parser.parse_args()
    worse = 0
    print(HEADING)
    with tempfile.TemporaryDirectory() as name:
        folders = fetched(given.repository, Path(name))
        for demo in (each for each in DEMOS if fnmatch(each.path, given.only)):
            line, is_worse = row(demo, folders)
            print(line, flush=True)
            worse += is_worse
        print("\n" + "\n".join([OTHERS, *not_run(folders.library)]))
    return 1 if worse else 0


def fetched(repository: str, folder: Path) -> Folders:
    """Return the demos, once for each way to run them."""
    folders = Folders(folder / "library", folder / "layer", folder / "rewritten")
    git("clone", "--quiet", repository, str(folders.library))
    git("-C", str(folders.library), "checkout", "--quiet", COMMIT)
    for each in folders[1:]:
        shutil.copytree(folders.library, each)
    return folders


def git(*words: str) -> None:
    """Run git."""
    subprocess.run(["git", *words], check=True)


def row(demo: Demo, folders: Folders) -> tuple[str, bool]:
    """Return a line of the table, and whether the demo fails only with our layer."""
    decisions = rewrite(folders.rewritten / demo.path)
    ways = [
        (folders.library, WITH_LIBRARY),
        (folders.layer, WITH_LAYER),
        (folders.rewritten, WITH_LIBRARY),
    ]
    with ThreadPoolExecutor(len(ways)) as pool:
        theirs, ours, rewritten = pool.map(lambda way: outcome(demo, *way), ways)
    for each in (theirs, ours, rewritten):
        if each.detail:
            print(f"{demo.path}: {each.detail}", file=sys.stderr, flush=True)
    layer = f"{ours.word}: it {demo.refused}" if demo.refused else ours.word
    words = " | ".join((theirs.word, layer, rewritten.word))
    return f"| `{demo.path}` | {words} | {decisions} |", is_better(demo, theirs.word, ours.word)


def rewrite(script: Path) -> int:
    """Rewrite a demo and its helper; return the number of decisions."""
    found = migrate(script.read_text(encoding="utf-8"), script.name)
    script.write_text(found.text, encoding="utf-8")
    for helper in script.parent.glob("port_setup.py"):
        helper.write_text(migrate(helper.read_text("utf-8")).text, encoding="utf-8")
    return len(found.decisions)


def is_better(demo: Demo, theirs: str, ours: str) -> bool:
    """Return whether a demo runs better with the library than with our layer."""
    if demo.is_test:
        return theirs != ours
    if demo.refused:
        return False
    return theirs.startswith(RUNS) and not ours.startswith(RUNS)


def not_run(repository: Path) -> Iterator[str]:
    """Return a line for each pattern of programs that are not run.

    Raises:
        SystemExit: a program is neither run nor listed with a reason.
    """
    found = [path for folder in FOLDERS for path in (repository / folder).rglob("*.py")]
    names = {path.relative_to(repository).as_posix() for path in found}
    left = names - {demo.path for demo in DEMOS}
    for pattern, why in NOT_RUN.items():
        here = {name for name in left if fnmatch(name, pattern)}
        left -= here
        yield f"| `{pattern}` | {len(here)} | {why} |"
    if left:
        raise SystemExit(f"neither run nor listed: {', '.join(sorted(left))}")


if __name__ == "__main__":
    raise SystemExit(main())
