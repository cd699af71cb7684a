"""Rewrites the text of one program."""

from __future__ import annotations

from typing import NamedTuple

import libcst as cst
from libcst.codemod import CodemodContext
from libcst.codemod.visitors import AddImportsVisitor
from libcst.metadata import MetadataWrapper

from cobotwire.protocol.errors import UsageError
from cobotwire.pymycobot.migrate.decisions import Decision
from cobotwire.pymycobot.migrate.names import Names
from cobotwire.pymycobot.migrate.rewriter import Rewriter


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
    names = Names()
    # Twice: a method of a class may use an arm that a later method opens.
    wrapper.module.visit(names)
    wrapper.module.visit(names)
    rewriter = Rewriter(names)
    module = wrapper.visit(rewriter)
    if rewriter.sleeps:
        context = CodemodContext()
        AddImportsVisitor.add_needed_import(context, "time")
        module = AddImportsVisitor(context).transform_module(module)
    return Migrated(module.code, tuple(sorted(set(rewriter.decisions))))
