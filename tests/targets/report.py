"""Print vectors, fields and differences for each target and edition; run by ``make targets``.

The exit code is 1 if there is a difference, 2 if a target could not run.
"""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path

from rich.console import Console
from rich.table import Table

from strategies import TABLES
from targets.comparison import Comparison, ToolMissing

HERE = Path(__file__).parent
SHOWN = 5


def main() -> int:
    """Compare every target; print the table and the differences."""
    console = Console()
    table = Table("target", "edition", "vectors", "fields", "differences")
    differences: list[str] = []
    missing = False
    for path in sorted(HERE.glob("*/comparison.py")):
        target = path.parent.name
        for edition in sorted(TABLES):
            with console.status(f"{target}, {edition}"):
                found = _compare(target, edition)
            if isinstance(found, ToolMissing):
                table.add_row(target, edition, "", "", f"not run: {found}")
                missing = True
                continue
            counts = (found.vectors, found.fields, len(found.differences))
            table.add_row(target, edition, *(f"{count:,}" for count in counts))
            differences += [f"{target}, {edition}: {text}" for text in found.differences[:SHOWN]]
    console.print(table)
    for line in differences:
        console.print(line, markup=False)
    return 1 if differences else 2 if missing else 0


def _compare(target: str, edition: str) -> Comparison | ToolMissing:
    try:
        found: Comparison = import_module(f"targets.{target}.comparison").compare(edition)
    except ToolMissing as error:
        return error
    return found


if __name__ == "__main__":
    sys.exit(main())
