"""The model to text: every generated file of an edition."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import Any

from jinja2 import (
    ChoiceLoader,
    Environment,
    FileSystemLoader,
    PackageLoader,
    StrictUndefined,
)

from cobotwire_codegen import lower
from cobotwire_codegen.model import Edition, Enum, Flag, Quantity, Type, Value
from cobotwire_codegen.render import markdown, parameters, python_api, python_table, words
from cobotwire_codegen.render.diagram import byte_diagram
from cobotwire_codegen.render.literal import literal, quoted
from cobotwire_codegen.render.vectors_json import vectors_json
from cobotwire_codegen.render.way import BLOCKING, WAYS, Way
from cobotwire_codegen.wire import size

Files = dict[PurePosixPath, str]


def render_python(edition: Edition, templates: Path | None = None) -> Files:
    """The edition's Python package: paths are relative to the package's folder.

    Templates in ``templates`` take the place of those of the same name.
    """
    jinja = environment(templates)
    edition = replace(edition, types=_used_types(edition))
    common = {"edition": edition, "named": _named_types(edition)}
    files = {
        PurePosixPath(f"{name}.py"): jinja.get_template(f"python/{name}.py.j2").render(common)
        for name in ("__init__", "enums", "values")
    }
    # So that type checkers believe the package's annotations where it is installed.
    files[PurePosixPath("py.typed")] = ""
    for part in ("__init__", "places", "types"):
        template = jinja.get_template(f"python/table/{part}.py.j2")
        files[PurePosixPath(f"table/{part}.py")] = template.render(common)
    for family in edition.families:
        template = jinja.get_template("python/table/family.py.j2")
        path = PurePosixPath(f"table/{family.name}.py")
        files[path] = template.render(common, family=family)
    for way in WAYS:
        files |= _client(jinja, common, way)
    return files


def _client(jinja: Environment, common: dict[str, Any], way: Way) -> Files:
    """A client for one way of calling: the same templates make all of them."""
    edition: Edition = common["edition"]
    name = "client.py" if way is BLOCKING else f"{way.folder}_client.py"
    made = {
        name: jinja.get_template("python/client.py.j2").render(common, way=way),
        f"{way.folder}/__init__.py": jinja.get_template("python/commands/__init__.py.j2").render(
            common, way=way
        ),
    }
    template = jinja.get_template("python/commands/family.py.j2")
    for family in edition.families:
        made[f"{way.folder}/{family.name}.py"] = template.render(common, family=family, way=way)
    return {PurePosixPath(path): text for path, text in made.items()}


def render_reference(edition: Edition, templates: Path | None = None) -> Files:
    """The edition's command reference in Markdown: a page a family, and an index."""
    jinja = environment(templates)
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


def render_vectors(edition: Edition) -> Files:
    """The table and vectors as JSON."""
    return {PurePosixPath(f"{edition.name}.json"): vectors_json(edition)}


def template_names() -> list[str]:
    """The templates that can be replaced, by their names."""
    return PackageLoader("cobotwire_codegen").list_templates()


def _used_types(edition: Edition) -> tuple[Type, ...]:
    """The types that a message has: a delta may have left some of its base's without a use."""
    fields = (field for command in edition.commands for field in command.fields)
    used = {type.name for field in fields for _, type in lower.cases(field)}
    return tuple(type for type in edition.types if type.name in used)


def _named_types(edition: Edition) -> dict[Type, str]:
    return {type: type.name.upper() for type in edition.types}


def environment(templates: Path | None = None) -> Environment:
    """What every template may use; those in ``templates`` take the place of ours."""
    shipped = PackageLoader("cobotwire_codegen")
    own = [FileSystemLoader(templates)] if templates is not None else []
    jinja = Environment(
        loader=ChoiceLoader([*own, shipped]),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,  # noqa: S701  (the output is Python, Markdown, JSON and Lua, never HTML)
    )
    jinja.globals.update(
        api=python_api,
        params=parameters,
        table=python_table,
        words=words,
        md=markdown,
        lower=lower,
    )
    jinja.filters.update(
        literal=literal,
        quoted=quoted,
        docstring=python_api.docstring,
        escaped=python_api.escaped,
        wrapped=python_api.wrapped,
        capitalize_first=python_api.capitalize_first,
        oneline=python_api.oneline,
        by_class=_by_class,
        byte_diagram=byte_diagram,
        size_on_wire=size,
    )
    jinja.tests.update(
        enum=lambda type: isinstance(type, Enum),
        value=lambda type: isinstance(type, Value),
        flag=lambda type: isinstance(type, Flag),
        quantity=lambda type: isinstance(type, Quantity),
    )
    return jinja


def _by_class(types: tuple[Type, ...]) -> Iterator[Enum | Value]:
    """Types that become a class, each class once."""
    seen = set()
    for type in types:
        if isinstance(type, Enum | Value) and type.class_name not in seen:
            seen.add(type.class_name)
            yield type
