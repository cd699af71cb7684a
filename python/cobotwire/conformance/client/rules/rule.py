"""What a rule is, and the list of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cobotwire.conformance.client.past import Heard, Past

# None: the rule is not about this; "": it is kept; else what is wrong, in words.
Judgement = str | None
Judge = Callable[[Past, Heard], Judgement]


class Rule(NamedTuple):
    """A rule for what a client sends; ``what`` says it, ``source`` is why it is one."""

    id: str
    what: str
    source: str
    judge: Judge


RULES: list[Rule] = []


def rule(id: str, what: str, source: str) -> Callable[[Judge], Judge]:
    """Enter a function as a rule."""

    def enter(judge: Judge) -> Judge:
        RULES.append(Rule(id, what, source, judge))
        return judge

    return enter
