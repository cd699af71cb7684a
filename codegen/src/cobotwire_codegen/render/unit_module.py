"""Render the module in which the package looks up the plurals of units."""

from __future__ import annotations

from cobotwire_codegen.language.units import UNITS


def render_units() -> str:
    """Return the module ``cobotwire.protocol.units``."""
    entries = "".join(f'    "{name}": "{unit.plural}",\n' for name, unit in UNITS.items())
    return (
        "# GENERATED from cobotwire_codegen.language.units; not to be edited.\n"
        '"""The plural of each unit, as it follows a number in a text."""\n\n'
        "from __future__ import annotations\n\n"
        "from typing import Final\n\n"
        "PLURALS: Final[dict[str, str]] = {\n" + entries + "}\n"
    )
