"""Writes a Wireshark dissector in Lua for each edition: one file for the plugin folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path, PurePosixPath

from jinja2 import Template

from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import Files, environment
from cobotwire_codegen.targets.wireshark.commands import Commands
from cobotwire_codegen.targets.wireshark.fields import Declared
from cobotwire_codegen.targets.wireshark.frame import frame_table
from cobotwire_codegen.targets.wireshark.lua import lua


def render_wireshark(editions: Sequence[Edition], templates: Path | None = None) -> Files:
    """Return a dissector for each edition; ``templates`` replace the shipped ones."""
    jinja = environment(templates)
    jinja.filters["lua"] = lua
    template = jinja.get_template("wireshark/dissector.lua.j2")
    return {PurePosixPath(f"{each.name}.lua"): _dissector(template, each) for each in editions}


def _dissector(template: Template, edition: Edition) -> str:
    declared = Declared(edition)
    commands = Commands(edition, declared)
    return template.render(
        edition=edition,
        filter=declared.protocol,
        frame=frame_table(edition.frame),
        declared=declared.all,
        numbers=commands.numbers,
        commands=commands.all,
    )
