"""Renders the data of the library's classes, their types, and the page that compares the calls."""

from __future__ import annotations

from itertools import groupby
from pathlib import PurePosixPath

from cobotwire_codegen.library.data import absent_json, stated
from cobotwire_codegen.library.language import RESULTS
from cobotwire_codegen.library.model import Library, LibraryClass, Method
from cobotwire_codegen.library.stub import Stub, constructor, native, native_call, our_call
from cobotwire_codegen.render import Files, environment


def render_library(library: Library) -> Files:
    """Return the data and types of the classes, and a module for each module of the library."""
    jinja = environment()
    jinja.globals.update(constructor=constructor, names=names, native=native)
    made: Files = {PurePosixPath("absent.json"): absent_json(library)}
    text = jinja.get_template("library/classes.pyi.j2").render(stub=Stub(library))
    made[PurePosixPath("layer", "classes.pyi")] = text
    data, found = PurePosixPath("layer", "data"), stated(library)
    made[data / "__init__.py"] = jinja.get_template("library/data.py.j2").render(found=found)
    for each in found:
        text = jinja.get_template("library/stated.py.j2").render(library=library, stated=each)
        made[data / f"{each.file}.py"] = text
    index = jinja.get_template("library/index.py.j2").render(library=library)
    made[PurePosixPath("__init__.py")] = index
    template = jinja.get_template("library/module.py.j2")
    listed = sorted(library.classes, key=lambda each: (each.module, each.name))
    for module, classes in groupby(listed, key=lambda each: each.module):
        text = template.render(library=library, classes=list(classes))
        made[PurePosixPath(f"{module}.py")] = text
    return made


def render_page(library: Library) -> Files:
    """Return the page that lists the library's calls with ours."""
    jinja = environment()
    jinja.globals.update(
        differing=differing, native_call=native_call, results=RESULTS, their_call=their_call
    )
    text = jinja.get_template("library/page.md.j2").render(library=library)
    return {PurePosixPath("pymycobot.md"): text}


def differing(given: LibraryClass) -> list[Method]:
    """Return the methods of a class that are called differently in our client."""
    return [method for method in given.methods if our_call(method) or method.result != "plain"]


def their_call(method: Method) -> str:
    """Return how the library's method is called, with the defaults."""
    parts = [f"{p.name}={p.default}" if p.default else p.name for p in method.parameters]
    return f"{method.name}({', '.join(parts)})"


def names(library: Library) -> list[str]:
    """Return the names that the package exports, in the order that ruff requires."""
    constants = ["PI_BAUD", "PI_PORT"]
    classes = sorted([each.name for each in library.classes] + ["Angle", "Coord"])
    return [*constants, *classes, "utils"]
