"""Checks the model: one small function for each rule, all problems at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire_codegen.check import (
    arguments,
    commands,
    evidence,
    names,
    read_back,
    reserved,
    roles,
    types,
    variants,
)
from cobotwire_codegen.errors import Problem, SpecError
from cobotwire_codegen.model import Edition

Rule = Callable[[Edition], Iterator[Problem]]

RULES: tuple[Rule, ...] = (
    *names.RULES,
    *reserved.RULES,
    *types.RULES,
    *commands.RULES,
    *variants.RULES,
    *arguments.RULES,
    *read_back.RULES,
    *roles.RULES,
    *evidence.RULES,
)


def check(edition: Edition) -> None:
    """Apply every rule.

    Raises:
        SpecError: the edition breaks rules; the error carries all problems.
    """
    problems = [problem for rule in RULES for problem in rule(edition)]
    if problems:
        raise SpecError(problems)
