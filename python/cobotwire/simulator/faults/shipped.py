"""Scenarios that come with the package: one for each observation of the field notes."""

from __future__ import annotations

from pathlib import Path

from cobotwire.protocol.errors import UsageError, did_you_mean
from cobotwire.protocol.table import Table
from cobotwire.simulator.faults.reader import load
from cobotwire.simulator.faults.scenario import Scenario

FOLDER = Path(__file__).parent / "scenarios"


def shipped() -> dict[str, Path]:
    """Return the files by name, sorted."""
    return {path.stem: path for path in sorted(FOLDER.glob("*.yaml"))}


def find(wanted: str, table: Table | None = None) -> Scenario:
    """Return the scenario in a file, or the one of that name that comes with the package.

    A name with a slash, or with the suffix ``.yaml`` or ``.yml``, is a file.

    Raises:
        UsageError: there is no such file or scenario.
        ScenarioError: the file is not a scenario.
    """
    if "/" in wanted or "\\" in wanted or wanted.endswith((".yaml", ".yml")):
        return load(wanted, table)
    known = shipped()
    if wanted not in known:
        hint = did_you_mean(wanted, known) or f"; choose from {', '.join(known)}, or name a file"
        raise UsageError("scenario", wanted, message=f"there is no scenario {wanted!r}{hint}")
    return load(known[wanted], table)
