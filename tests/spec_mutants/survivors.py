"""Reads ``unconfirmed.yaml``: the facts without a second source, each with the reason."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

from ruamel.yaml import YAML

from spec_mutants.spec_files import ROOT


@cache
def _unconfirmed() -> list[dict[str, Any]]:
    path = ROOT / "tests" / "spec_mutants" / "unconfirmed.yaml"
    rows: list[dict[str, Any]] = YAML(typ="safe").load(path.read_text())["unconfirmed"]
    return rows


def accepted(edition: str, kind: str, title: str) -> str:
    """Return why a mutant may survive; empty if it may not."""
    for row in _unconfirmed():
        named = edition in row.get("editions", [edition])
        if named and re.fullmatch(row["facts"], f"{kind} {title}"):
            return str(row["why"])
    return ""
