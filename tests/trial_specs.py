"""Build small specs of other robots: an edition's package, made from text in a test."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import RULES
from cobotwire_codegen.errors import Problem
from cobotwire_codegen.model import Edition
from small_specs import package

HEAD = """
edition: trial
class: Trial
title: A trial
doc: A robot of a test.
"""
FOOTED = """
frame:
  frame:
    header: FE FE
    footer: FA
    length_counts: [command, data, footer]
    maximum_data: 32
    doc: A small frame.
  transport: {baudrate: 115200, deadline_ms: 300}
"""


def edition_of(text: str, folder: Path) -> tuple[Edition, list[Problem]]:
    """Return a spec's edition, and its problems except for missing vectors."""
    path = folder / "trial.yaml"
    path.write_text(text)
    edition = build_edition(path, folder)
    problems = [problem for rule in RULES for problem in rule(edition)]
    return edition, [problem for problem in problems if problem.code != "no-vector"]


def package_of(text: str, folder: Path) -> AbstractContextManager[Any]:
    """Return the imported package of a spec, which has no problems."""
    edition, problems = edition_of(text, folder)
    assert problems == []
    return imported(edition, folder)


def imported(edition: Edition, folder: Path) -> AbstractContextManager[Any]:
    """Return the imported package of an edition, generated into a folder."""
    return nullcontext(package(folder, edition))
