"""The parts of an edition as nodes: its own files, laid over those of its base.

Whatever an edition names may stand in a file of its own or right there, so that a small protocol
can be one file.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from cobotwire_codegen.errors import Place, Problem, SpecError, nearest
from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence, load
from cobotwire_codegen.model import Change
from cobotwire_codegen.reader import Reader

Named = dict[str, tuple[Place, Node]]
SECTIONS = ("wire", "quantities", "flags", "enums", "values")


@dataclass
class FamilyParts:
    """A family of commands, not yet built."""

    place: Place
    name: str
    title: str
    doc: str
    commands: Named = field(default_factory=dict)


@dataclass
class Parts:
    """An edition, not yet built. A delta changes these in place."""

    frame: Node | None = None
    link: Node | None = None
    joints: int | None = None
    acks: Node | None = None
    types: dict[str, Named] = field(default_factory=lambda: {name: {} for name in SECTIONS})
    families: dict[str, FamilyParts] = field(default_factory=dict)
    vectors: list[Node] = field(default_factory=list)
    errata: list[Node] = field(default_factory=list)
    changes: dict[str, list[Change]] = field(default_factory=dict)
    general_changes: list[Change] = field(default_factory=list)

    def family_of(self, command: str) -> FamilyParts | None:
        """The family that holds a command."""
        holders = (family for family in self.families.values() if command in family.commands)
        return next(holders, None)

    def commands(self) -> Iterator[str]:
        """The names of all commands."""
        for family in self.families.values():
            yield from family.commands


class Files:
    """Loads what an edition names, relative to the edition's own file."""

    def __init__(self, folder: Path, root: Path, problems: list[Problem]) -> None:
        self._folder = folder
        self._root = root
        self._problems = problems

    def load(self, path: Path) -> Node:
        """A file's content."""
        path, root = path.resolve(), self._root.resolve()
        shown = path.relative_to(root) if path.is_relative_to(root) else path
        return load(path, shown.as_posix())

    def path(self, node: Node) -> Path:
        """The file that a node names.

        Raises:
            SpecError: there is none, and nothing can be said of what it would hold.
        """
        name = node.value if isinstance(node, Scalar) else None
        if not isinstance(name, str) or not self._is_file(name):
            shown = str(name) if len(str(name)) <= 80 else f"{str(name)[:77]}..."
            problem = Problem(node.place, "no-file", f"there is no file {shown}")
            raise SpecError([*self._problems, problem])
        return self._folder / name

    def _is_file(self, name: str) -> bool:
        try:
            return (self._folder / name).is_file()
        except (OSError, ValueError):  # a name that no file can have
            return False

    def content(self, node: Node) -> Node:
        """The content of the file that a node names, or the node itself if it names none."""
        return self.load(self.path(node)) if isinstance(node, Scalar) else node

    def listed(self, reader: Reader, key: str) -> list[Node]:
        """The contents of a list of files."""
        return [self.content(node) for node in reader.items(key)]


def add_own(parts: Parts, reader: Reader, files: Files) -> None:
    """Lay an edition's own files over the parts of its base."""
    _add_frame(parts, reader, files)
    if reader.node("joints") is not None or parts.joints is None:
        parts.joints = reader.integer("joints")
        if parts.joints < 0:
            reader.problem("bad-number", f"an edition cannot have {parts.joints} joints")
    parts.acks = reader.node("acks") or parts.acks
    node = reader.node("types")
    if node is not None:
        _add_types(parts, files.content(node), reader.problems)
    _add_commands(parts, reader, files)
    for key, found in (("vectors", parts.vectors), ("errata", parts.errata)):
        node = reader.node(key)
        for item in node.items if isinstance(node, Sequence) else (node,) if node else ():
            found.extend(_listed(files.content(item), key, reader.problems))


def _add_frame(parts: Parts, reader: Reader, files: Files) -> None:
    node = reader.node("frame") if parts.frame is not None else reader.required("frame")
    if node is None:
        return
    inner = Reader(files.content(node), "the frame file", reader.problems)
    parts.frame = inner.required("frame")
    parts.link = inner.node("link") or parts.link
    if parts.link is None:
        inner.required("link")
    inner.done()


def _add_types(parts: Parts, root: Node, problems: list[Problem]) -> None:
    """Add a types file; a name that is taken is a problem."""
    reader = Reader(root, "the types file", problems)
    taken = {name: place for named in parts.types.values() for name, (place, _) in named.items()}
    for section in SECTIONS:
        for name, place, node in reader.entries(section):
            if name in taken:
                message = f"{name} is a type already, at {taken[name]}"
                problems.append(Problem(place, "duplicate-type", message))
            taken[name] = place
            parts.types[section][name] = (place, node)
    reader.done()


def _add_commands(parts: Parts, reader: Reader, files: Files) -> None:
    node = reader.node("commands")
    if isinstance(node, Mapping):
        # A protocol in one file: its commands are one family.
        new = FamilyParts(node.place, "commands", "Commands", "All commands.")
        _fill(parts, parts.families.get("commands") or new, node, reader.problems)
        return
    for content in files.listed(reader, "commands"):
        inner = Reader(content, "the commands file", reader.problems)
        name, title, doc = inner.text("family"), inner.text("title"), inner.text("doc")
        # A delta adds to a family of its base by using its name.
        new = FamilyParts(content.place, name, title, doc)
        commands = inner.required("commands")
        inner.done()
        if commands is not None:
            _fill(parts, parts.families.get(name) or new, commands, reader.problems)


def _fill(parts: Parts, family: FamilyParts, node: Node, problems: list[Problem]) -> None:
    parts.families[family.name] = family
    if not isinstance(node, Mapping):
        problems.append(Problem(node.place, "wrong-kind", "commands must be a mapping"))
        return
    for name, content in node.entries.items():
        holder = parts.family_of(name)
        if holder is None:
            family.commands[name] = (node.keys[name], content)
        else:
            message = f"{name} is a command already, at {holder.commands[name][0]}"
            problems.append(Problem(node.keys[name], "duplicate-command", message))


def _listed(root: Node, key: str, problems: list[Problem]) -> list[Node]:
    """The entries of a vectors or errata file, or one that stands right there."""
    if not (isinstance(root, Mapping) and key in root.entries):
        return [root]
    reader = Reader(root, f"the {key} file", problems)
    found = list(reader.items(key))
    reader.done()
    return found


def find(known: Iterator[str], name: str, what: str, place: Place, problems: list[Problem]) -> bool:
    """Whether a name is known; if not, that is a problem."""
    names = list(known)
    if name in names:
        return True
    message = f"there is no {what} {name}{nearest(name, names)}"
    problems.append(Problem(place, f"unknown-{what}", message))
    return False
