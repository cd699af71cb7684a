"""Finds what a delta edition's package can import unchanged from the package of its base."""

from __future__ import annotations

from typing import Any

from cobotwire_codegen.model import Bits, Command, Edition, Enum, Family, Value
from cobotwire_codegen.render import python_api
from cobotwire_codegen.render.layout import import_line
from cobotwire_codegen.render.messages import classes_used, message_classes
from cobotwire_codegen.render.parameters import element_type, reported_type, results, returns

PACKAGE = "cobotwire.editions"


class Sharing:
    """Finds the classes, messages and methods that are equal in an edition and its base.

    Without a base (``base`` is None) nothing is shared, and the package imports no other.
    """

    def __init__(self, edition: Edition, base: Sharing | None = None) -> None:
        self.edition = edition
        self.base = base
        self._package = f"{PACKAGE}.{edition.name}"
        self._classes = _classes(edition)
        self._families = {c.name: f for f in edition.families for c in f.commands}
        self._methods = {c.name: python_api.method(c) for c in edition.commands}
        self._messages = {c.name: message_classes(c) for c in edition.commands}
        self.shared_classes = self._find_shared_classes()
        self.shared_commands = {
            command.name
            for command in edition.commands
            if base is not None
            and base._messages.get(command.name) == self._messages[command.name]
            and classes_used(command) <= self.shared_classes
        }

    def _find_shared_classes(self) -> set[str]:
        if self.base is None:
            return set()
        found = {n for n, parts in self._classes.items() if self.base._classes.get(n) == parts}
        # A named tuple of results differs if a class that it contains differs.
        for command in self.edition.commands:
            if returns(command) in found and not classes_used(command) <= found:
                found.discard(returns(command))
        return found

    @property
    def base_package(self) -> str:
        """The full name of the base's package."""
        assert self.base is not None, f"{self.edition.name} has no base to import from"
        return self.base._package

    def shared_enums(self) -> list[str]:
        """Return the enums that come from the base, in the order in which ruff sorts imports."""
        found = [n for n in python_api.enum_classes(self.edition) if n in self.shared_classes]
        return sorted(found, key=str.lower)

    def value_imports(self) -> list[str]:
        """Return the imports of the module of named tuples."""
        names = python_api.value_classes(self.edition)
        lines = []
        if set(names) - self.shared_classes:
            lines += ["from typing import NamedTuple", ""]
        shared = [
            import_line(f"{self.base_package}.values", [f"{n} as {n}"])
            for n in names
            if n in self.shared_classes
        ]
        enums = [n for n in python_api.enums_in_values(self.edition)]
        lines += [*shared, *([""] if shared and enums else [])]
        if enums:
            lines.append(import_line(".enums", enums))
        return lines if lines[-1:] != [""] else lines[:-1]

    def messages_module(self, family: Family) -> str:
        """Return the module that holds a family's messages; it may be the base's."""
        taken_over = self._whole_in_base(family)
        if taken_over is not None:
            assert self.base is not None
            return self.base.messages_module(taken_over)
        return f"{self._package}.messages.{family.name}"

    def methods_module(self, family: Family) -> str:
        """Return the module that holds a family's methods; it may be the base's."""
        taken_over = self._whole_in_base(family)
        if taken_over is not None and self.base is not None:
            same = (family.title, family.doc) == (taken_over.title, taken_over.doc)
            if same and all(self._is_same_method(c, taken_over) for c in family.commands):
                return self.base.methods_module(taken_over)
        return f"{self._package}.commands.{family.name}"

    def shared_methods(self, family: Family) -> list[str]:
        """Return the methods that a family and the family of that name in the base both have."""
        other = self._same_family(family)
        if other is None:
            return []
        return [
            c.name for c in python_api.methods(family.commands) if self._is_same_method(c, other)
        ]

    def base_import(self, family: Family) -> str:
        """Return the import of the base's family as ``Base``."""
        other = self._same_family(family)
        assert self.base is not None
        assert other is not None, f"the base has no family {family.name} to import"
        module = self.base.methods_module(other).replace(f"{PACKAGE}.", "...", 1)
        return import_line(module, [f"{python_api.family_class(family)} as Base"])

    def _is_same_method(self, command: Command, family: Family) -> bool:
        """Return whether a family of the base has the same method, with the same messages."""
        assert self.base is not None
        name = command.name
        return (
            name in self.shared_commands
            and self.base._families[name] is family
            and self.base._methods[name] == self._methods[name]
        )

    def is_own(self, module: str) -> bool:
        """Return whether a module belongs to this edition's package."""
        return module.startswith(f"{self._package}.")

    def relative(self, module: str) -> str:
        """Return the name by which modules in the package's folder import another module."""
        return module.removeprefix(self._package) if self.is_own(module) else module

    def message_imports(self, family: Family) -> list[str]:
        """Return the imports of a family's module of messages."""
        own = [c for c in family.commands if c.name not in self.shared_commands]
        used = set().union(*(classes_used(command) for command in own))
        classes = [found for command in own for found in message_classes(command)]
        lines = []
        if any("Sequence[" in field for found in classes for field in found.fields):
            lines.append("from collections.abc import Sequence")
        if any(found.constructors for found in classes):
            lines.append("from typing import TYPE_CHECKING, Any, overload")
        if lines:
            lines.append("")
        shared = []
        if self.base is not None:
            for command in (c for c in family.commands if c.name in self.shared_commands):
                module = self.base.messages_module(self.base._families[command.name])
                module = module.replace(f"{PACKAGE}.", "...", 1)
                shared += [(module, found.name) for found in message_classes(command)]
        # ruff sorts by module and then by name.
        again = [
            import_line(module, [f"{name} as {name}"])
            for module, name in sorted(shared, key=_by_name)
        ]
        bases = [
            n
            for n in ("Event", "Reply", "Request")
            if any(c.parts[0].startswith(n) for c in classes)
        ]
        if bases:
            lines.append(import_line("cobotwire.protocol.messages", bases))
        again += local_imports(self.edition, used)
        return [*lines, *([""] if again and lines else []), *again]

    def _whole_in_base(self, family: Family) -> Family | None:
        """Return the base's family with exactly the same messages; None if no family has them."""
        other = self._same_family(family)
        if other is None or not {c.name for c in family.commands} <= self.shared_commands:
            return None
        same = [c.name for c in other.commands] == [c.name for c in family.commands]
        return other if same else None

    def _same_family(self, family: Family) -> Family | None:
        """Return the base's family of the same name, if there is one."""
        families = () if self.base is None else self.base.edition.families
        return next((other for other in families if other.name == family.name), None)


def _by_name(shared: tuple[str, str]) -> tuple[str, str, str]:
    """Return the key by which import lines are sorted, as linters sort them."""
    module, name = shared
    return module, name.lower(), name


def local_imports(edition: Edition, names: set[str]) -> list[str]:
    """Return the imports of enums and named tuples from a module in a subfolder."""
    enums = sorted(names & set(python_api.enum_classes(edition)))
    values = sorted(names & set(python_api.value_classes(edition)))
    return [
        import_line(f"..{module}", found)
        for module, found in (("enums", enums), ("values", values))
        if found
    ]


def _classes(edition: Edition) -> dict[str, Any]:
    """Return what makes up each enum and named tuple, without its place in the spec."""
    found: dict[str, Any] = {}
    for type in edition.types:
        if isinstance(type, Enum):
            members = [(member.name, member.value, member.doc) for member in type.members]
            found.setdefault(type.class_name, (type.doc, members))
        elif isinstance(type, Value | Bits):
            items = [(name, element_type(item)) for name, item in type.items]
            found.setdefault(type.class_name, (type.doc, items, python_api.item_docs(type)))
    for command in edition.commands:
        if command.text is not None:
            found[command.text.class_name] = (command.name, command.text.fields)
        elif len(results(command)) > 1:
            parts = [(r.name, reported_type(r), r.doc) for r in results(command)]
            found[returns(command)] = (command.name, parts)
    return found
