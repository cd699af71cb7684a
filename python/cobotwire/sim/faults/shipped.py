"""Scenarios that come with the package, by name: one for each thing that field notes tell."""

from __future__ import annotations

from pathlib import Path

from cobotwire.errors import UsageError
from cobotwire.sim.faults.reader import load
from cobotwire.sim.faults.rules import nearest
from cobotwire.sim.faults.scenario import Scenario
from cobotwire.table import Table

FOLDER = Path(__file__).parent / "scenarios"


def shipped() -> dict[str, Path]:
    """The files by name, in the order of the alphabet."""
    return {path.stem: path for path in sorted(FOLDER.glob("*.yaml"))}


def find(wanted: str, table: Table | None = None) -> Scenario:
    """The scenario in a file, or the one that comes with the package under that name.

    What holds a slash or ends in ``.yaml`` or ``.yml`` is a file.

    Raises:
        UsageError: it is neither; the text names the nearest spelling.
        ScenarioError: the file is no scenario.
    """
    if "/" in wanted or "\\" in wanted or wanted.endswith((".yaml", ".yml")):
        return load(wanted, table)
    known = shipped()
    if wanted not in known:
        allowed = f"a file, or one of {', '.join(known)}{nearest(wanted, known)}"
        raise UsageError("scenario", wanted, allowed)
    return load(known[wanted], table)
