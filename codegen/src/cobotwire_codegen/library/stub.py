"""Render the .pyi stub of the classes of the maker's library; it states each method once."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from itertools import groupby, zip_longest

from cobotwire_codegen.library.data import place_of
from cobotwire_codegen.library.model import Library, LibraryClass, Method
from cobotwire_codegen.library.parameters import Typed, of_constructor, of_method
from cobotwire_codegen.render.layout import WIDTH, docstring, escaped, import_line

_LAYER = "cobotwire.pymycobot.layer"


class Stub:
    """The classes of the library for type checkers and editors.

    Methods that several classes have are in a class of their own, from which these inherit.
    """

    def __init__(self, library: Library) -> None:
        self.classes = library.classes
        owners: dict[str, list[str]] = {}
        for given in library.classes:
            for method in given.methods:
                owners.setdefault(_stated(method), []).append(given.name)
        # The methods by the classes that have them.
        self._methods: dict[tuple[str, ...], list[str]] = {}
        for text, names in sorted(owners.items()):
            self._methods.setdefault(tuple(names), []).append(text)
        shared = [names for names in self._methods if len(names) > 1]
        self._shared = {names: f"_Methods{n}" for n, names in enumerate(shared, start=1)}

    def shared(self) -> Iterator[tuple[str, list[str]]]:
        """Yield the classes of shared methods."""
        for names, name in self._shared.items():
            yield name, self._methods[names]

    def methods(self, given: LibraryClass) -> list[str]:
        """Return the methods that only one class has."""
        return self._methods.get((given.name,), [])

    def bases(self, given: LibraryClass) -> str:
        """Return the class line: shared methods, helpers, a similar class, or the common base."""
        shared = [name for names, name in self._shared.items() if given.name in names]
        helpers = [place_of(each)[1] for each in given.helpers]
        found = [*helpers, *([given.like] if given.like else [])] or ["CompatibleClient"]
        return _packed(f"class {given.name}(", [*shared, *found], "):", 0)

    def imports(self) -> list[str]:
        """Return the imports."""
        used = {name for each in self.classes for name in (each.edition.name, each.elsewhere.name)}
        found = [
            import_line("cobotwire.editions", sorted(used)),
            import_line(f"{_LAYER}.client", ["CompatibleClient", "OnFailure"]),
        ]
        helpers = sorted({place_of(helper) for each in self.classes for helper in each.helpers})
        for module, group in groupby(helpers, key=lambda place: place[0]):
            found.append(import_line(f"{_LAYER}.{module}", [name for _, name in group]))
        return sorted(found)


def native(given: LibraryClass) -> list[str]:
    """Return the attributes that state which of our clients a class uses."""
    here, there = (f"{each.name}.{each.class_name}" for each in (given.edition, given.elsewhere))
    both = [here] if here == there else [there, here]
    return [f"NATIVE: ClassVar[type[{here}]]", f"arm: {' | '.join(both)}"]


def constructor(given: LibraryClass) -> str:
    """Return the head of the constructor of a class."""
    parts = ["self", *_parameters(of_constructor(given)), "*", "errors: OnFailure | None = None"]
    return _packed("def __init__(", parts, ") -> None: ...", 4)


def _stated(method: Method) -> str:
    """Return a method of the stub: its head, what it does, and the call of our method."""
    parts = ["self", *_parameters(of_method(method))]
    head = _packed(f"def {method.name}(", parts, ") -> Any:", 4)
    title, ours = method.command.title, our_call(method)
    text = docstring(f"{title}: ``{native_call(method)}``." if ours else f"{title}.", 8)
    if "\n" in text:
        # The summary has a line of its own.
        text = f'        """{escaped(title)}.\n\n        {ours}\n        """'
    return f"{head}\n{text}"


def _packed(head: str, parts: list[str], tail: str, indent: int) -> str:
    """Return ``head parts tail`` on as few lines as possible, without breaking a part."""
    head, tail, *parts = (each.replace(" ", "\0") for each in (head, tail, *parts))
    text = f"{head}{', '.join(parts)}{tail}"
    lines = textwrap.wrap(text, WIDTH - indent, subsequent_indent="    ", break_on_hyphens=False)
    return f"\n{' ' * indent}".join(lines).replace("\0", " ")


def _parameters(typed: Typed) -> list[str]:
    return [
        f"{each.name}: {kind}" + (f" = {each.default}" if each.default else "").replace("'", '"')
        for each, kind in typed
    ]


def our_call(method: Method) -> str:
    """Return a sentence that shows the call of our method; empty if the arguments are the same."""
    if tuple(each.name for each in method.parameters) == method.command.argument_names:
        return ""
    return f"Calls ``{native_call(method)}``."


def native_call(method: Method) -> str:
    """Return the call of our method; an argument that the library's method fixes is a value."""
    device = f"at({method.address})." if method.address else ""
    ours = method.command.argument_names
    pairs = zip_longest(ours, method.passes[: len(ours)], fillvalue="")
    shown = [name if given in {"", *method.takes} else given for name, given in pairs]
    return f"{device}{method.command.name}({', '.join(shown)})"
