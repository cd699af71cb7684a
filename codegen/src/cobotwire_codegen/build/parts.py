"""Collects the parts of an edition as nodes: its own files, added to those of its base.

An edition may contain the content of a file instead of naming the file, so that a small protocol
fits into one file.
"""

from __future__ import annotations

from collections import abc
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from cobotwire_codegen import language
from cobotwire_codegen.build.packages import names_package, packaged_edition, packaged_hint
from cobotwire_codegen.errors import Place, Problem, SpecError, nearest
from cobotwire_codegen.language.records import Key
from cobotwire_codegen.language.shapes import items_of
from cobotwire_codegen.load import (
    MOST_BYTES_TOGETHER,
    MOST_NODES_TOGETHER,
    Mapping,
    Node,
    Scalar,
    Sequence,
    loaded,
    parsed,
)
from cobotwire_codegen.model import Change, Edition, Vector
from cobotwire_codegen.reader import Reader

Named = dict[str, tuple[Place, Node]]
# The content of files, as text or parsed.
Unsaved = abc.Mapping[Path, str | Node]


@dataclass
class FamilyParts:
    """A family of commands as nodes."""

    place: Place
    name: str
    title: str
    doc: str
    commands: Named = field(default_factory=dict)


class Inherited(NamedTuple):
    """A vector of the base, and the name that the delta gives its command."""

    vector: Vector
    command: str


@dataclass
class Parts:
    """An edition as nodes. A delta changes them in place."""

    # The folder to which the file names of places are relative.
    root: Path
    frame: Node | None = None
    transport: Node | None = None
    joints: int | None = None
    robot: dict[str, Node] = field(default_factory=dict)
    # Why there is no geometry; ignored if the edition states one.
    geometry_unknown: str = ""
    # The state of the arm, by name; and the names that the edition itself states, not its base.
    state: Named = field(default_factory=dict)
    own_state: set[str] = field(default_factory=set)
    acks: Node | None = None
    # Commands that a delta exempts from the rule in `acks`.
    unacknowledged: set[str] = field(default_factory=set)
    types: dict[str, Named] = field(
        default_factory=lambda: {name: {} for name in language.SECTIONS}
    )
    families: dict[str, FamilyParts] = field(default_factory=dict)
    vectors: list[Node] = field(default_factory=list)
    inherited: list[Inherited] = field(default_factory=list)
    errata: list[Node] = field(default_factory=list)
    evidence: list[Node] = field(default_factory=list)
    base: Edition | None = None
    changes: dict[str, list[Change]] = field(default_factory=dict)
    # Commands of the base that the delta removes, each with a hint for entries that still name it.
    gone: dict[str, str] = field(default_factory=dict)
    general_changes: list[Change] = field(default_factory=list)

    def family_of(self, command: str) -> FamilyParts | None:
        """Return the family that holds a command."""
        holders = (family for family in self.families.values() if command in family.commands)
        return next(holders, None)

    def commands(self) -> Iterator[str]:
        """Return the names of all commands."""
        for family in self.families.values():
            yield from family.commands


class Texts:
    """Loads files by path; texts that an editor has not saved yet replace their content.

    A text may also be given as the node that it contains.
    """

    def __init__(self, root: Path, unsaved: Unsaved) -> None:
        self.root, self._unsaved = root.resolve(), unsaved
        self._bytes = self._nodes = 0

    def replaced(self, path: Path) -> bool:
        """Return whether a text replaces the content of a file, which then need not exist."""
        return path.resolve() in self._unsaved

    def load(self, path: Path, place: Place | None = None) -> Node:
        """Return the content of a file that is named at ``place``.

        Raises:
            SpecError: the file cannot be read, or all files together exceed a limit.
        """
        path = path.resolve()
        shown = path.relative_to(self.root) if path.is_relative_to(self.root) else path
        text, name = self._unsaved.get(path), shown.as_posix()
        if text is not None and not isinstance(text, str):
            return text
        content = loaded(path, name) if text is None else parsed(text, name)
        self._bytes += content.bytes
        self._nodes += content.nodes
        for size, most, what in (
            (self._bytes, MOST_BYTES_TOGETHER, "bytes"),
            (self._nodes, MOST_NODES_TOGETHER, "values"),
        ):
            if size > most:
                message = f"with this file the edition has more than {most} {what}, the limit"
                raise SpecError([Problem(place or Place(name, 1, 1), "too-large", message)])
        return content.root


class Files:
    """Loads the files that an edition names, relative to the edition's own file."""

    def __init__(self, folder: Path, texts: Texts, problems: list[Problem]) -> None:
        self._folder = folder
        self._texts = texts
        self._problems = problems

    def load(self, path: Path, place: Place | None = None) -> Node:
        """Return the content of a file that is named at ``place``."""
        return self._texts.load(path, place)

    def path(self, node: Node) -> Path:
        """Return the path of the file, or of the package's edition, that a node names.

        Raises:
            SpecError: the file or package does not exist, so reading cannot continue.
        """
        name = node.value if isinstance(node, Scalar) else None
        if isinstance(name, str) and names_package(name):
            return packaged_edition(name, node.place)
        if not isinstance(name, str) or not self._is_file(name):
            shown = str(name) if len(str(name)) <= 80 else f"{str(name)[:77]}..."
            message = f"there is no file {shown}{packaged_hint(str(name))}"
            problem = Problem(node.place, "no-file", message)
            raise SpecError([*self._problems, problem])
        return self._folder / name

    def _is_file(self, name: str) -> bool:
        try:
            path = self._folder / name
            return self._texts.replaced(path) or path.is_file()
        except (OSError, ValueError):  # a name that no file can have
            return False

    def content(self, node: Node) -> Node:
        """Return the content of the file that a node names, or the node itself."""
        return self.load(self.path(node), node.place) if isinstance(node, Scalar) else node

    def listed(self, reader: Reader, key: Key[Node | None]) -> list[Node]:
        """Return the contents of a list of files."""
        node = reader.get(key)
        subject = f"{key.name} of {reader.what}"
        nodes = () if node is None else items_of(node, subject, reader.problem)
        return [self.content(node) for node in nodes]


def add_own(parts: Parts, reader: Reader, files: Files) -> None:
    """Add an edition's own files to the parts of its base."""
    _add_frame(parts, reader, files)
    spec = language.WholeEdition
    if reader.node(spec.joints) is not None or parts.joints is None:
        joints, parts.joints = parts.joints, reader.get(spec.joints)
        if joints != parts.joints:
            # With another number of joints, the base's facts about joints do not apply.
            for name in language.JOINT_KEYS:
                parts.robot.pop(name, None)
    _add_robot(parts, reader)
    acks = reader.get(spec.acks)
    if acks is not None:
        parts.acks, parts.unacknowledged = acks, set()
    node = reader.get(spec.types)
    if node is not None:
        _add_types(parts, files.content(node), reader.problems)
    _add_commands(parts, reader, files)
    for item in _one_or_many(reader.get(spec.vectors)):
        parts.vectors += _listed(files.content(item), language.VectorsFile.vectors, reader.problems)
    for item in _one_or_many(reader.get(spec.errata)):
        parts.errata += _listed(files.content(item), language.ErrataFile.errata, reader.problems)
    parts.evidence += files.listed(reader, spec.evidence)


def drop_firmware(parts: Parts) -> None:
    """Drop the versions of firmware that the base states: another robot has firmware of its own."""
    for family in parts.families.values():
        for name, (place, node) in family.commands.items():
            if isinstance(node, Mapping) and language.Command.firmware.name in node.entries:
                kept = {k: v for k, v in node.entries.items() if k != "firmware"}
                family.commands[name] = (place, Mapping(node.place, kept, node.keys))


def _add_robot(parts: Parts, reader: Reader) -> None:
    spec = language.WholeEdition
    unknown = reader.get(spec.geometry_unknown)
    if unknown:
        parts.robot.pop("geometry", None)
        parts.geometry_unknown = unknown
    for name in language.ROBOT_KEYS:
        node = reader.node(spec.keys()[name])
        if node is not None:
            parts.robot[name] = node
    parts.own_state = set()
    for name, place, node in reader.get(spec.state):
        parts.own_state.add(name)
        _, before = parts.state.get(name, (place, node))
        parts.state[name] = (place, _over(before, node))


def _over(before: Node, node: Node) -> Node:
    """Return ``before`` updated with the keys of ``node``; ``node`` if one is not a mapping."""
    if not (isinstance(before, Mapping) and isinstance(node, Mapping)):
        return node
    return Mapping(node.place, before.entries | node.entries, before.keys | node.keys)


def _one_or_many(node: Node | None) -> tuple[Node, ...]:
    return node.items if isinstance(node, Sequence) else () if node is None else (node,)


def _add_frame(parts: Parts, reader: Reader, files: Files) -> None:
    spec = language.FrameFile
    node = reader.get(language.WholeEdition.frame)
    if node is None:
        return
    inner = Reader(files.content(node), spec, "the frame file", reader.problems)
    parts.frame = inner.get(spec.frame)
    parts.transport = inner.get(spec.transport) or parts.transport
    if parts.transport is None:
        inner.problem("missing-key", f"the frame file lacks the key {spec.transport.name}")


def _add_types(parts: Parts, root: Node, problems: list[Problem]) -> None:
    """Add a types file; report names that are already used."""
    spec = language.TypesFile
    reader = Reader(root, spec, "the types file", problems)
    taken = {name: place for named in parts.types.values() for name, (place, _) in named.items()}
    for section, key in spec.keys().items():
        for name, place, node in reader.get(key):
            if name in taken:
                message = f"there is already a type {name} at {taken[name]}"
                problems.append(Problem(place, "duplicate-type", message))
            taken[name] = place
            parts.types[section][name] = (place, node)


def _add_commands(parts: Parts, reader: Reader, files: Files) -> None:
    spec = language.CommandsFile
    node = reader.get(language.WholeEdition.commands)
    if isinstance(node, Mapping):
        # A protocol in one file: its commands are one family.
        new = FamilyParts(node.place, "commands", "Commands", "All commands.")
        _fill(parts, parts.families.get("commands") or new, node, reader.problems)
        return
    for content in files.listed(reader, language.WholeEdition.commands):
        inner = Reader(content, spec, "the commands file", reader.problems)
        name, title, doc = (inner.get(key) for key in (spec.family, spec.title, spec.doc))
        # A delta adds to a family of its base by using its name.
        new = FamilyParts(content.place, name, title, doc)
        commands = inner.node(spec.commands)
        if commands is not None:
            _fill(parts, parts.families.get(name) or new, commands, reader.problems)


def _fill(parts: Parts, family: FamilyParts, node: Node, problems: list[Problem]) -> None:
    parts.families[family.name] = family
    shape = language.CommandsFile.commands.shape

    def note(code: str, message: str, place: Place) -> None:
        problems.append(Problem(place, code, message))

    for name, place, content in shape.read(node, "commands", note):
        holder = parts.family_of(name)
        if holder is None:
            family.commands[name] = (place, content)
        else:
            message = f"there is already a command {name} at {holder.commands[name][0]}"
            problems.append(Problem(place, "duplicate-command", message))


def _listed(root: Node, key: Key[tuple[Node, ...]], problems: list[Problem]) -> list[Node]:
    """Return the entries of a vectors or errata file, or a single entry."""
    if not (isinstance(root, Mapping) and key.name in root.entries):
        return [root]
    record = language.FILES[key.name]
    reader = Reader(root, record, f"the {key.name} file", problems)
    return [*reader.get(key)]


def find(known: Iterator[str], name: str, what: str, place: Place, problems: list[Problem]) -> bool:
    """Return whether a name is known; report a problem if it is not."""
    names = list(known)
    if name in names:
        return True
    message = f"there is no {what} {name}{nearest(name, names)}"
    problems.append(Problem(place, f"unknown-{what}", message))
    return False
