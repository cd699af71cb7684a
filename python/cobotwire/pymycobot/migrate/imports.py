"""Rewrites the imports of the library."""

from __future__ import annotations

from collections.abc import Iterable

import libcst as cst
from libcst.helpers import get_full_name_for_node

from cobotwire.pymycobot import error
from cobotwire.pymycobot.migrate.calls import library

OURS = "cobotwire.pymycobot"
# The names in the layer that are not classes, by the module of the library.
KEPT = {
    "": {"PI_BAUD", "PI_PORT", "Angle", "Coord", "utils"},
    "genre": {"Angle", "Coord"},
    "error": {name for name in vars(error) if name.endswith("Exception")},
    "utils": {"get_port_list", "detect_port_of_basic"},
}


def rewritten(node: cst.ImportFrom) -> tuple[list[cst.ImportFrom], list[str]]:
    """Return the imports that replace one of the library, and the names that are not replaced."""
    module = (get_full_name_for_node(node.module) or "") if node.module else ""
    rest = module.partition(".")[2]
    if isinstance(node.names, cst.ImportStar):
        return [node], ["*"]
    ours: list[cst.ImportAlias] = []
    kept: list[cst.ImportAlias] = []
    left: list[cst.ImportAlias] = []
    for alias in node.names:
        name = alias.evaluated_name
        if name in library():
            native = library()[name].native
            ours.append(alias.with_changes(name=cst.Name(native)))
        elif name in KEPT.get(rest, set()):
            kept.append(alias)
        else:
            left.append(alias)
    lines = [_line("cobotwire", ours)] if ours else []
    lines += [_line(f"{OURS}.{rest}".rstrip("."), kept)] if kept else []
    lines += [_line(module, left)] if left else []
    return lines, [alias.evaluated_name for alias in left]


def _line(module: str, names: Iterable[cst.ImportAlias]) -> cst.ImportFrom:
    listed = list({alias.evaluated_name: alias for alias in names}.values())
    comma = cst.Comma(whitespace_after=cst.SimpleWhitespace(" "))
    listed = [each.with_changes(comma=comma) for each in listed]
    listed[-1] = listed[-1].with_changes(comma=cst.MaybeSentinel.DEFAULT)
    parsed = cst.parse_expression(module)
    assert isinstance(parsed, cst.Name | cst.Attribute), "it is the name of a module"
    return cst.ImportFrom(module=parsed, names=listed)
