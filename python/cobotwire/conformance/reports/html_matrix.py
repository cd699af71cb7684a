"""The matrix of commands and test cases as HTML."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from xml.etree.ElementTree import Element

from cobotwire.conformance.report import Report
from cobotwire.conformance.reports.element import element
from cobotwire.conformance.reports.html_parts import (
    SIGNS,
    anchor,
    class_of,
    heading,
    sign_of,
    title_of,
)
from cobotwire.conformance.reports.matrix import Cell, case_ids, commands, matrix


def matrix_of(report: Report) -> Iterator[Element]:
    """Yield the section: a row for each command, a column for each test case."""
    cells = matrix(report)
    columns = case_ids(cells)
    heads = (element("th", element("span", case), scope="col") for case in columns)
    rows = []
    for command in commands(cells):
        link = element("a", title_of(command), href=f"#{anchor(command)}")
        found = [cells.get((command, case)) for case in columns]
        rows.append(element("tr", element("th", link, scope="row"), *_row(found)))
    yield heading("matrix", "Commands and test cases")
    signs = ", ".join(f"{sign} {cause or verdict}" for (verdict, cause), sign in SIGNS.items())
    yield element("p", f"{signs}. A command leads to its results.", class_="faint")
    head = element("thead", element("tr", element("th", "command"), *heads))
    table = element("table", head, element("tbody", *rows), class_="matrix")
    yield element("div", table, class_="scroll", tabindex="0")


def _row(cells: list[Cell | None]) -> Iterator[Element]:
    """Yield the cells of a row; empty ones next to each other are one cell, which is shorter."""
    for empty, group in groupby(cells, key=lambda cell: cell is None):
        found = list(group)
        if empty:
            yield element("td", colspan=len(found)) if len(found) > 1 else element("td")
        for cell in found:
            if cell is not None:
                outcome = cell.gravest.verdict, cell.gravest.cause
                yield element("td", sign_of(*outcome), class_=class_of(*outcome))
