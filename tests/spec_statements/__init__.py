"""States facts of the spec a second time, from sources other than the spec."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire_codegen.model import Edition
from spec_statements import effects, maker, meanings, mercury, quantities, recorded, requests

Statement = Callable[[Edition], Iterator[str]]

STATEMENTS: tuple[Statement, ...] = (
    *meanings.RULES,
    *effects.RULES,
    *quantities.RULES,
    *maker.RULES,
    *mercury.RULES,
    *recorded.RULES,
    *requests.RULES,
)
