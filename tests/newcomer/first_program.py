"""Run the `console` blocks of the README, with what `pip install cobotwire` installs."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from docs.pages import run

README = Path(__file__).parents[2] / "README.md"


def main() -> int:
    """Return 1 if a command prints something other than the README shows."""
    with tempfile.TemporaryDirectory() as folder:
        runs = list(run(README, Path(folder), ""))
    for done in runs:
        print("ok  " if done.matches else f"FAIL {done}", done.command)
    return 0 if runs and all(done.matches for done in runs) else 1


if __name__ == "__main__":
    sys.exit(main())
