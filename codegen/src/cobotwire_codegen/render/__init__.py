"""Renders the model as text: every generated file of an edition."""

from __future__ import annotations

from binascii import crc32
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import groupby
from pathlib import Path, PurePosixPath
from typing import Any

from jinja2 import (
    BaseLoader,
    ChoiceLoader,
    Environment,
    FileSystemLoader,
    PackageLoader,
    StrictUndefined,
)
from jinja2.sandbox import SandboxedEnvironment

from cobotwire_codegen import lower
from cobotwire_codegen.model import Bits, Edition, Enum, Flag, Listed, Quantity, Type, Value
from cobotwire_codegen.publish import edition_json, errata_json
from cobotwire_codegen.render import examples, layout, markdown, parameters, python_api, words
from cobotwire_codegen.render.byte_table import byte_rows, check_words, on_one_line, only_fixed
from cobotwire_codegen.render.diagram import byte_diagram
from cobotwire_codegen.render.effects import effect_in_words
from cobotwire_codegen.render.escape_markdown import escaped
from cobotwire_codegen.render.example_call import example_call, example_result
from cobotwire_codegen.render.literal import literal, quoted
from cobotwire_codegen.render.messages import message_classes
from cobotwire_codegen.render.sharing import Sharing, local_imports
from cobotwire_codegen.wire import size

Files = dict[PurePosixPath, str]


def render_python(
    edition: Edition, templates: Path | None = None, base: Sharing | None = None
) -> Files:
    """Return the edition's Python package: paths are relative to the package's folder.

    Args:
        edition: the checked edition.
        templates: a folder of templates; each replaces the shipped template of the same name.
        base: the edition that this one is a delta of, whose package it may import.
    """
    jinja = environment(templates)
    edition = with_used_types(edition)
    sharing = Sharing(edition, base)
    table = edition_json(edition)
    checksum = f"{crc32(table.encode()):08x}"
    common = {"edition": edition, "sharing": sharing, "checksum": checksum}
    files = {
        PurePosixPath(f"{name}.py"): jinja.get_template(f"python/{name}.py.j2").render(common)
        for name in ("__init__", "enums", "table", "values")
    }
    # Type checkers use the annotations of an installed package only if it has this file.
    files[PurePosixPath("py.typed")] = ""
    files[PurePosixPath("edition.json")] = table
    if edition.errata:
        files[PurePosixPath("errata.json")] = errata_json(edition)
    return files | _messages(jinja, common) | _methods(jinja, common) | _clients(jinja, common)


def _package_of(module: str) -> str:
    return module.rpartition(".")[0]


def _messages(jinja: Environment, common: dict[str, Any]) -> Files:
    """Return the modules of typed requests and replies, one for each family that has its own."""
    sharing: Sharing = common["sharing"]
    template = jinja.get_template("python/messages/family.py.j2")
    made: Files = {}
    modules: dict[str, list[str]] = {"own": [], "shared": []}
    for family in sharing.edition.families:
        module = sharing.messages_module(family)
        if not sharing.is_own(module):
            modules["shared"].append(module)
        else:
            modules["own"].append(f".{family.name}")
            own = (c for c in family.commands if c.name not in sharing.shared_commands)
            classes = [found for command in own for found in message_classes(command)]
            made[PurePosixPath(f"messages/{family.name}.py")] = template.render(
                common, family=family, classes=classes
            )
    index = jinja.get_template("python/messages/__init__.py.j2")
    made[PurePosixPath("messages/__init__.py")] = index.render(
        common,
        **{key: sorted(names) for key, names in modules.items()},
        shared_by_package=[list(g) for _, g in groupby(sorted(modules["shared"]), _package_of)],
    )
    return made


def _methods(jinja: Environment, common: dict[str, Any]) -> Files:
    """Return the modules of methods, one for each family that has its own."""
    sharing: Sharing = common["sharing"]
    template = jinja.get_template("python/commands/family.py.j2")
    made = {
        PurePosixPath(f"commands/{family.name}.py"): template.render(common, family=family)
        for family in sharing.edition.families
        if sharing.is_own(sharing.methods_module(family))
    }
    if made:
        index = jinja.get_template("python/commands/__init__.py.j2")
        made[PurePosixPath("commands/__init__.py")] = index.render(common)
    return made


def _clients(jinja: Environment, common: dict[str, Any]) -> Files:
    """Return the blocking and the asyncio client; one template generates both."""
    sharing: Sharing = common["sharing"]
    template = jinja.get_template("python/client.py.j2")
    name = sharing.edition.class_name
    table = "from cobotwire.protocol.table import Table"
    moves = python_api.moves(sharing.edition)
    imports = [table]
    own = ["from .table import TABLE"]
    bases: list[str] = []
    if moves:
        imports.append("from cobotwire.client.moving import MovingClient")
        bases.append("MovingClient")
    for family in sharing.edition.families:
        module = sharing.methods_module(family)
        bases.append(python_api.family_class(family))
        line = f"from {sharing.relative(module)} import {bases[-1]}"
        (own if sharing.is_own(module) else imports).append(line)
    blocking = template.render(
        common,
        prefix="",
        imports=[*sorted(imports), "", *sorted(own)],
        head=layout.laid_out(f"class {name}(", bases, "):", 0),
    )
    module, base = ("aio_moving", "AsyncMovingClient") if moves else ("aio", "AsyncClient")
    asynchronous = template.render(
        common,
        prefix="Async",
        imports=[
            f"from cobotwire.client.{module} import {base}",
            "from cobotwire.client.methods import asynchronous",
            table,
            "",
            f"from .client import {name}",
            "from .table import TABLE",
        ],
        head=f"class Async{name}({base}):",
    )
    return {
        PurePosixPath("client.py"): blocking,
        PurePosixPath("aio_client.py"): asynchronous,
    }


def render_reference(edition: Edition, templates: Path | None = None) -> Files:
    """Return the command reference in Markdown: an index, and a page for each family."""
    jinja = environment(templates)
    edition = escaped(edition)
    files = {
        PurePosixPath("README.md"): jinja.get_template("markdown/index.md.j2").render(
            edition=edition
        )
    }
    template = jinja.get_template("markdown/family.md.j2")
    for family in edition.families:
        text = template.render(edition=edition, family=family)
        files[PurePosixPath(f"{family.name}.md")] = text
    return files


def template_names() -> list[str]:
    """Return the names of the templates that can be replaced."""
    return PackageLoader("cobotwire_codegen").list_templates()


def with_used_types(edition: Edition) -> Edition:
    """Return the edition without unused types: a delta may stop using types of its base."""
    fields = [field for command in edition.commands for field in command.fields]
    types = [type for field in fields for _, type in lower.cases(field)]
    types += [type.of for type in types if isinstance(type, Listed)]
    types += [part for type in types if isinstance(type, Bits) for _, part in type.items]
    used = {type.name for type in types}
    return replace(edition, types=tuple(type for type in edition.types if type.name in used))


def environment(templates: Path | None = None) -> Environment:
    """Return the environment of all templates; those in ``templates`` replace the shipped ones.

    Jinja's sandbox stops the usual attacks by a foreign template. It gives no guarantee, since the
    objects that templates receive were not designed for it.
    """
    if templates is None:
        return _shipped()
    # Do not cache this environment: during `watch`, the user may add a template.
    return _environment(
        SandboxedEnvironment, FileSystemLoader(templates), PackageLoader("cobotwire_codegen")
    )


@cache
def _shipped() -> Environment:
    """Return the environment of the shipped templates, so that each is compiled once."""
    return _environment(Environment, PackageLoader("cobotwire_codegen"))


def _environment(kind: type[Environment], *loaders: BaseLoader) -> Environment:
    """Return an environment that takes each template from the first loader that has it."""
    jinja = kind(
        loader=ChoiceLoader(loaders),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        # The output is Python, Markdown, JSON and Lua, each escaped by its own filter.
        autoescape=False,
    )
    jinja.globals.update(
        api=python_api,
        params=parameters,
        words=words,
        md=markdown,
        examples=examples,
        byte_rows=byte_rows,
        check_words=check_words,
        only_fixed=only_fixed,
        on_one_line=on_one_line,
        effect_in_words=effect_in_words,
        example_call=example_call,
        example_result=example_result,
        lower=lower,
        local_imports=local_imports,
    )
    jinja.filters.update(
        literal=literal,
        quoted=quoted,
        docstring=layout.docstring,
        escaped=layout.escaped,
        wrapped=layout.wrapped,
        capitalize_first=layout.capitalize_first,
        oneline=layout.oneline,
        by_class=_by_class,
        byte_diagram=byte_diagram,
        size_on_wire=size,
    )
    jinja.tests.update(
        enum=lambda type: isinstance(type, Enum),
        value=lambda type: isinstance(type, Value | Bits),
        flag=lambda type: isinstance(type, Flag),
        quantity=lambda type: isinstance(type, Quantity),
    )
    return jinja


def _by_class(types: tuple[Type, ...]) -> Iterator[Enum | Value | Bits]:
    """Yield the types that become a class, each class once."""
    seen = set()
    for type in types:
        if isinstance(type, Enum | Value | Bits) and type.class_name not in seen:
            seen.add(type.class_name)
            yield type
