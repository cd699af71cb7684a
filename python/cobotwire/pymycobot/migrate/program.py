"""Rewrites the text of one program."""

from __future__ import annotations

from typing import NamedTuple

import libcst as cst
from libcst.codemod import CodemodContext
from libcst.codemod.visitors import AddImportsVisitor
from libcst.metadata import MetadataWrapper

from cobotwire.protocol.errors import UsageError
from cobotwire.pymycobot.migrate.bindings import Bindings
from cobotwire.pymycobot.migrate.decisions import Decision
from cobotwire.pymycobot.migrate.keys import Keys
from cobotwire.pymycobot.migrate.names import Names
from cobotwire.pymycobot.migrate.places import Places
from cobotwire.pymycobot.migrate.rewriter import Rewriter
from cobotwire.pymycobot.migrate.uses import Uses


class Migrated(NamedTuple):
    """A program that uses our clients, and what a person must decide, in its order."""

    text: str
    decisions: tuple[Decision, ...]


def migrate(text: str, name: str = "the program") -> Migrated:
    """Rewrite a program of the maker's library.

    What cannot be rewritten stays as it is, and is listed.

    Args:
        text: the program.
        name: its file, for errors.

    Raises:
        UsageError: the text is not Python.
    """
    try:
        wrapper = MetadataWrapper(cst.parse_module(text))
    except cst.ParserSyntaxError as error:
        place = f"{name}:{error.raw_line}:{error.raw_column + 1}"
        raise UsageError("script", place, "a program of Python 3") from None
    keys, found = Keys(wrapper), Bindings()
    wrapper.module.visit(found)
    uses = Uses(Names(keys, found))
    decisions: set[Decision] = set()

    def decide(node: cst.CSTNode, what: str) -> None:
        start = keys.positions[node].start
        decisions.add(Decision(start.line, start.column + 1, what))

    rewriter = Rewriter(uses, decide)
    module = wrapper.module.visit(rewriter)
    wrapper.module.visit(Places(uses, decide))
    if rewriter.sleeps:
        context = CodemodContext()
        AddImportsVisitor.add_needed_import(context, "time")
        module = AddImportsVisitor(context).transform_module(module)
    return Migrated(module.code, tuple(sorted(decisions)))
