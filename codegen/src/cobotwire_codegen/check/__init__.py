"""Checks the model: one small function for each rule, all problems at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import (
    arguments,
    commands,
    effects,
    evidence,
    names,
    reserved,
    roles,
    samples,
    states,
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
    *samples.RULES,
    *roles.RULES,
    *states.RULES,
    *effects.RULES,
    *evidence.RULES,
)


# Rules that read only names, ids and places: other mistakes do not affect them.
INDEPENDENT: tuple[Rule, ...] = (
    *names.RULES,
    *reserved.RULES,
    commands.ids_unique,
    evidence.vectors_apart,
)


def checked_edition(path: Path, root: Path, unsaved: Mapping[Path, str] | None = None) -> Edition:
    """Return an edition, built and checked; the arguments are those of ``build_edition``.

    Raises:
        SpecError: the spec has problems. If it cannot be read completely, these are the problems of
        reading, and those of rules that do not depend on them.
    """
    try:
        edition = build_edition(path, root, unsaved)
    except SpecError as error:
        if error.partial is None:
            raise
        more = [problem for rule in INDEPENDENT for problem in rule(error.partial)]
        raise SpecError([*error.problems, *more]) from None
    check(edition)
    return edition


def check(edition: Edition) -> None:
    """Apply every rule.

    Raises:
        SpecError: the edition breaks rules; the error carries all problems.
    """
    problems = [problem for rule in RULES for problem in rule(edition)]
    if problems:
        raise SpecError(problems)
