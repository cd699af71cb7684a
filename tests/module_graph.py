"""Find which modules of the Python packages and the Rust crates import each other."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

Imports = dict[str, set[str]]


@cache
def _read(path: Path) -> tuple[list[ast.Import | ast.ImportFrom], list[str]]:
    """Return the imports of a file and its texts, cached: several tests need them for each file."""
    nodes = list(ast.walk(ast.parse(path.read_text())))
    texts = [node.value for node in nodes if isinstance(node, ast.Constant)]
    return (
        [node for node in nodes if isinstance(node, ast.Import | ast.ImportFrom)],
        [text for text in texts if isinstance(text, str)],
    )


def python_imports(path: Path, package: str) -> Iterator[str]:
    """Yield every module that a file imports, anywhere in it, by its full name."""
    for node in _read(path)[0]:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        else:
            base = node.module or ""
            if node.level:
                parent = package.split(".")[: -node.level]
                base = ".".join([*parent, base] if base else parent)
            yield base
            yield from (f"{base}.{alias.name}" for alias in node.names)


def python_imports_of(root: Path, name: str) -> Imports:
    """Return the modules that each module of the package ``name`` in folder ``root`` imports.

    ``from package import Name`` counts as an import of the package only if no module has that name.
    """
    modules = _python_modules(root, name)
    imports: Imports = {}
    for module, path in modules.items():
        context = f"{module}.__init__" if path.name == "__init__.py" else module
        named = [found for found in python_imports(path, context) if found in modules]
        # `from a import b` yields a and a.b; if a.b is a module, a is not counted.
        longest = {n for n in named if not any(m.startswith(f"{n}.") for m in named)}
        imports[module] = longest - {module}
    return imports


def modules_in_texts(path: Path, package: str) -> Iterator[str]:
    """Yield the modules of a package that texts in a file name, as ``import_module`` takes them."""
    for text in _read(path)[1]:
        if re.fullmatch(rf"{package}(\.\w+)+\.?", text):
            yield text.rstrip(".")


def imports_of_parts(imports: Imports, package: str) -> Imports:
    """Return which parts of a package import each other; a part is a module or a folder in it."""
    start = f"{package}."
    parts: Imports = {}
    for module, imported in imports.items():
        if module.startswith(start):
            part = _part(module, start)
            found = {_part(name, start) for name in imported if name.startswith(start)}
            parts.setdefault(part, set()).update(found - {part})
    return parts


def _part(module: str, start: str) -> str:
    return start + module.removeprefix(start).partition(".")[0]


def _python_modules(root: Path, name: str) -> dict[str, Path]:
    found = {}
    for path in sorted(root.rglob("*.py")):
        parts = path.relative_to(root).with_suffix("").parts
        found[".".join([name, *(part for part in parts if part != "__init__")])] = path
    return found


def rust_imports_of(root: Path) -> Imports:
    """Return the modules that each module of a crate uses; ``root`` is its ``src`` folder."""
    modules = {
        path.relative_to(root).with_suffix("").as_posix().removesuffix("/mod"): path.read_text()
        for path in root.rglob("*.rs")
        if path.stem not in ("lib", "main")
    }
    return {name: set(_used(name, text, set(modules))) - {name} for name, text in modules.items()}


def _used(module: str, text: str, modules: set[str]) -> Iterator[str]:
    """Yield the modules that a Rust file names in its paths: ``crate::a::b`` and ``super::b``."""
    code = re.sub(r"//.*", "", text.partition("#[cfg(test)]")[0])
    here = module.split("/")
    for match in re.finditer(r"\b(crate|super)((?:::\w+)+|::\{[^;]*\})", code):
        start = [] if match[1] == "crate" else here[:-1]
        for words in _paths(match[2].removeprefix("::")):
            path = [*start, *words]
            while path and "/".join(path) not in modules:
                path.pop()
            if path and path != here[: len(path)]:
                yield "/".join(path)


def _paths(tree: str) -> Iterator[list[str]]:
    """Split ``{a::b, c::{d, e}}`` into the leading words of its branches."""
    if not tree.startswith("{"):
        yield tree.split("::")
        return
    for branch in re.split(r",\s*(?![^{}]*\}[^}])", tree.strip("{}")):
        yield [word for word in branch.strip().split("{")[0].split("::") if word]


def import_cycle(imports: Mapping[str, set[str]]) -> list[str]:
    """Return the modules of an import cycle; an empty list without one."""
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        cycle: list[str] = error.args[1]
        return cycle
    return []
