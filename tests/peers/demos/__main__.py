"""``make demos``: print how the maker's demos run; exit 1 if one runs only with the library."""

from __future__ import annotations

import argparse
import subprocess
import tempfile
from pathlib import Path

from cobotwire.pymycobot.migrate import migrate
from demos.running import WITH_LAYER, WITH_LIBRARY, outcome
from demos.scripts import COMMIT, DEMOS, REPOSITORY, Demo


def main() -> int:
    """Fetch the demos and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repository", default=REPOSITORY, help="where to clone the demos from")
    given = parser.parse_args()
    worse = 0
    print("| demo | with the library | with our layer | rewritten | to decide |")
    print("|---|---|---|---|--:|")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "maker"
        git("clone", "--quiet", given.repository, str(folder))
        git("-C", str(folder), "checkout", "--quiet", COMMIT)
        for demo in DEMOS:
            worse += row(demo, folder)
    return 1 if worse else 0


def git(*words: str) -> None:
    """Run git."""
    subprocess.run(["git", *words], check=True)


def row(demo: Demo, folder: Path) -> bool:
    """Print a line of the table; return whether the demo runs with the library alone."""
    theirs = outcome(demo, folder, WITH_LIBRARY)
    ours = outcome(demo, folder, WITH_LAYER)
    script = folder / demo.path
    text = script.read_text(encoding="utf-8")
    helpers = [(path, path.read_text("utf-8")) for path in script.parent.glob("port_setup.py")]
    found = migrate(text, demo.path)
    script.write_text(found.text, encoding="utf-8")
    for path, helper in helpers:
        path.write_text(migrate(helper).text, encoding="utf-8")
    rewritten = outcome(demo, folder, WITH_LIBRARY)
    for path, before in [(script, text), *helpers]:
        path.write_text(before, encoding="utf-8")
    decisions = len(found.decisions)
    print(f"| {demo.path} | {theirs} | {ours} | {rewritten} | {decisions} |", flush=True)
    return theirs.startswith("runs") and not ours.startswith("runs")


if __name__ == "__main__":
    raise SystemExit(main())
