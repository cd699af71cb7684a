"""Compare each target with all vectors of each edition; run by ``make targets``.

The exit code is 1 if there is a difference, 2 if a target could not run.
"""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path

from rich.console import Console
from rich.table import Table

from cobotwire_codegen.project import editions
from targets.comparison import Comparison, ToolMissing
from vectors import ROOT

HERE = Path(__file__).parent
SHOWN = 5


def main() -> int:
    """Compare every target; print the table and the differences."""
    console = Console()
    table = Table("target", "edition", "vectors", "to refuse", "fields", "differences")
    differences: list[str] = []
    missing = False
    names = sorted(edition.name for edition in editions(ROOT))
    for path in sorted(HERE.glob("*/comparison.py")):
        target = path.parent.name
        for edition in names:
            with console.status(f"{target}, {edition}"):
                found = _compare(target, edition)
            if isinstance(found, ToolMissing):
                table.add_row(target, edition, "", "", "", f"not run: {found}")
                missing = True
                continue
            counts = (found.vectors, found.refused, found.fields, len(found.differences))
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
