"""Write the template of a statement: everything is declared as implemented."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from cobotwire.conformance.statement.reader import FORMAT
from cobotwire.conformance.statement.statement import Support, equipment, is_mandatory
from cobotwire.protocol.table import Command, Table

HEAD = """\
# Implementation conformance statement: which commands of {edition} a device has.
# To test a device by it:
#
#   cobotwire --edition {edition} conform device URL --statement FILE
#
statement: {format}
edition: {edition}
maker: ""
product: ""
# As {version} reports it; empty: it is not compared.
firmware: ""
# Whether changes are acknowledged, where the edition allows it: all, none, unknown.
acknowledgements: unknown
"""
COMMANDS = """\
# implemented: tested. optional: tested, but silence is no failure. absent: not tested, except that
# it must not reply. A command that is left out is implemented, and those that are marked as
# mandatory cannot be anything else.
commands:
"""


def statement_template(table: Table) -> str:
    """Return the template for an edition, as YAML; it is a valid statement."""
    version = table.find_role("version")
    name = version.name if version else "the device"
    text = HEAD.format(edition=table.edition, format=FORMAT, version=name)
    families = equipment(table)
    if families:
        text += "# Equipment set to false is not tested.\nfitted:\n"
        text += "".join(f"  {family}: true\n" for family in families)
    return text + COMMANDS + "".join(f"{line}\n" for line in _commands(table))


def _commands(table: Table) -> Iterator[str]:
    usual = [command for command in table.commands if not command.event]
    for family, commands in groupby(usual, key=lambda command: command.family):
        yield f"  # {family}"
        for command in commands:
            yield _line(command)


def _line(command: Command) -> str:
    about = f"mandatory {command.safety}" if is_mandatory(command) else command.safety
    return f"  {command.name}: {Support.IMPLEMENTED}  # {about}"
