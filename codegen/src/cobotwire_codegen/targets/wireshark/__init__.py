"""A Wireshark dissector in Lua: a file an edition, which a plugin folder takes as it is."""

from __future__ import annotations

from pathlib import Path, PurePosixPath

from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import Files, environment
from cobotwire_codegen.targets.wireshark.commands import Commands
from cobotwire_codegen.targets.wireshark.fields import Declared
from cobotwire_codegen.targets.wireshark.lua import lua


def render_wireshark(edition: Edition, templates: Path | None = None) -> Files:
    """The edition's dissector; templates in ``templates`` take the place of the shipped ones."""
    jinja = environment(templates)
    jinja.filters["lua"] = lua
    declared = Declared(edition)
    commands = Commands(edition, declared)
    text = jinja.get_template("wireshark/dissector.lua.j2").render(
        edition=edition,
        filter=declared.protocol,
        declared=declared.all,
        numbers=commands.numbers,
        commands=commands.all,
    )
    return {PurePosixPath(f"{edition.name}.lua"): text}
