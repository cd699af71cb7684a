"""Builds the classes of the maker's library from ``spec/pymycobot.yaml`` and the editions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from cobotwire_codegen.errors import Problem, SpecError, nearest
from cobotwire_codegen.language.records import Entry, Key
from cobotwire_codegen.library import language
from cobotwire_codegen.library.model import QUIET, Library, LibraryClass, Method, Parameter
from cobotwire_codegen.load import Node, load
from cobotwire_codegen.model import Command, Edition
from cobotwire_codegen.reader import Reader
from cobotwire_codegen.render.arguments import arguments

_RANGE = re.compile(r"(\w+)=(-?\d+)\.\.(-?\d+)\Z")
_NUMBER = re.compile(r"-?\d+\Z")
# A default is a plain literal: None, a truth value, a number, a quoted word.
_PARAMETER = re.compile(
    r"(_?[a-z][A-Za-z0-9_]*)(?:=(None|True|False|-?\d+(?:\.\d+)?|'[\w./-]*'))?\Z"
)


class _Stated(NamedTuple):
    """The contents of the file: shared methods and classes by name, and editions."""

    methods: Mapping[str, Entry]
    classes: Mapping[str, Entry]
    editions: Mapping[str, Edition]


def build_library(path: Path, root: Path, editions: Iterable[Edition]) -> Library:
    """Return the library's classes.

    Raises:
        SpecError: the file is wrong; the error carries every problem.
    """
    problems: list[Problem] = []
    node = load(path, path.relative_to(root).as_posix())
    spec = language.Library
    reader = Reader(node, spec, "the library", problems)
    stated = _Stated(
        {entry[0]: entry for entry in reader.get(spec.methods)},
        {entry[0]: entry for entry in reader.get(spec.classes)},
        {edition.name: edition for edition in editions},
    )
    built = (_class(entry, stated, problems) for entry in stated.classes.values())
    classes = [each for each in built if each is not None]
    _check_likes(reader, classes)
    if problems:
        raise SpecError(problems)
    absent = _absent(reader.get(spec.absent), problems)
    return Library(reader.get(spec.library), absent, tuple(classes))


def _absent(groups: tuple[Node, ...], problems: list[Problem]) -> tuple[tuple[str, str], ...]:
    """Return the names that have no counterpart, each with the reason."""
    return tuple(
        (name, group.get(language.Absent.why))
        for node in groups
        for group in [Reader(node, language.Absent, "a group of names", problems)]
        for name in group.get(language.Absent.names)
    )


def _check_likes(reader: Reader, classes: list[LibraryClass]) -> None:
    earlier: set[str] = set()
    for each in classes:
        if each.like and each.like not in earlier:
            message = f"the class {each.name} is like {each.like}, which is not listed before it"
            reader.problem("unknown-word", message + nearest(each.like, earlier))
        earlier.add(each.name)


def _class(entry: Entry, stated: _Stated, problems: list[Problem]) -> LibraryClass | None:
    name, _, node = entry
    spec = language.Class
    reader = Reader(node, spec, f"the class {name}", problems)
    edition = _edition(reader, spec.edition, stated)
    elsewhere = _edition(reader, spec.elsewhere, stated) if reader.get(spec.elsewhere) else edition
    if edition is None or elsewhere is None:
        return None
    like = reader.get(spec.like)
    own = {entry[0]: entry for entry in reader.get(spec.methods)}
    commands = {command.name: command for command in edition.commands if not command.event}
    other = _other(reader, stated)
    offered = [each for each in _offered(reader, commands) if each not in other.lacks]
    shared = {key: value for key, value in stated.methods.items() if key in offered}
    taken = {key: value for key, value in other.methods.items() if other.calls[key] in commands}
    # A class like another one states only its own differences.
    wanted = own if like else {**dict.fromkeys(offered), **shared, **taken, **own}
    addresses = reader.get(spec.addresses)
    methods = [_method(key, given, commands, addresses, problems) for key, given in wanted.items()]
    return LibraryClass(
        name,
        reader.get(spec.module),
        reader.get(spec.doc),
        edition,
        elsewhere,
        reader.get(spec.ports),
        reader.get(spec.opens),
        _parameters(reader, spec.constructor),
        like,
        reader.get(spec.helpers),
        reader.get(spec.one_way),
        _absent(reader.get(spec.absent), problems),
        tuple(sorted(filter(None, methods), key=lambda method: method.name)),
    )


def _edition(reader: Reader, key: Key[str], stated: _Stated) -> Edition | None:
    given = reader.get(key)
    found = stated.editions.get(given)
    if found is None:
        message = f"{reader.what} has no edition {given}{nearest(given, stated.editions)}"
        reader.problem("unknown-word", message, reader.place_of(key))
    return found


class _Other(NamedTuple):
    """The facts of another class: its methods, the commands that they call, and what it lacks."""

    methods: Mapping[str, Entry]
    calls: Mapping[str, str]
    lacks: tuple[str, ...]


def _other(reader: Reader, stated: _Stated) -> _Other:
    """Return the class whose methods the stated class inherits; empty if it states none."""
    key = language.Class.methods_of
    name = reader.get(key)
    if not name:
        return _Other({}, {}, ())
    entry = stated.classes.get(name)
    if entry is None:
        message = f"{reader.what} has no class {name}{nearest(name, stated.classes)}"
        reader.problem("unknown-word", message, reader.place_of(key))
        return _Other({}, {}, ())
    # Mistakes of the other class are reported when that class is built.
    other = Reader(entry[2], language.Class, f"the class {name}", [])
    methods = {each[0]: each for each in other.get(language.Class.methods)}
    calls = {
        key: Reader(node, language.Method, key, []).get(language.Method.calls) or key
        for key, _, node in methods.values()
    }
    return _Other(methods, calls, other.get(language.Class.lacks))


def _offered(reader: Reader, commands: Mapping[str, Command]) -> list[str]:
    """Return the commands that a class offers under our name."""
    key = language.Class.lacks
    lacks = reader.get(key)
    for name in (name for name in lacks if name not in commands):
        message = f"{reader.what} lacks {name}, but no command has that name"
        reader.problem("unknown-command", message + nearest(name, commands), reader.place_of(key))
    return [name for name in commands if name not in lacks]


def _method(
    name: str,
    entry: Entry | None,
    commands: Mapping[str, Command],
    addresses: tuple[str, ...],
    problems: list[Problem],
) -> Method | None:
    if entry is None:
        return _as_ours(name, commands[name])
    spec = language.Method
    reader = Reader(entry[2], spec, f"the method {name}", problems)
    called = reader.get(spec.calls) or name
    command = commands.get(called)
    if command is None:
        message = f"{reader.what} calls {called}, which is not a command{nearest(called, commands)}"
        reader.problem("unknown-command", message)
        return None
    ours = _as_ours(name, command)
    parameters = _parameters(reader, spec.parameters) or ours.parameters
    names = tuple(each.name for each in parameters)
    passes, lacks = _known(reader, spec.passes, names), _known(reader, spec.lacks, names)
    kept = {QUIET, *addresses, *lacks}
    passed = passes or tuple(each for each in names if each not in kept)
    most = len(command.argument_names)
    if len(passed) > most:
        message = f"{reader.what} passes {len(passed)} parameters, but {called} takes {most}"
        reader.problem("bad-number", message)
    address = next((each for each in names if each in addresses), "")
    ranges = _ranges(reader, spec.ranges, names)
    result = reader.get(spec.result)
    return Method(name, command, parameters, passed, result, address, lacks, ranges)


def _ranges(
    reader: Reader, key: Key[tuple[str, ...]], parameters: tuple[str, ...]
) -> tuple[tuple[str, str, str], ...]:
    """Return the ranges of parameters; note wrong ranges and unknown parameters."""
    found = []
    for text in reader.get(key):
        match = _RANGE.match(text)
        if match is None or match[1] not in parameters:
            message = f"{reader.what} has the range {text}; write parameter=lowest..highest"
            reader.problem("bad-name", message, reader.place_of(key))
        else:
            found.append((match[1], match[2], match[3]))
    return tuple(found)


def _known(
    reader: Reader, key: Key[tuple[str, ...]], parameters: tuple[str, ...]
) -> tuple[str, ...]:
    """Return the parameters that a key lists; note those that the method does not have."""
    listed = reader.get(key)
    for unknown in (each for each in listed if each not in parameters and not _NUMBER.match(each)):
        message = f"{reader.what} has no parameter {unknown}{nearest(unknown, parameters)}"
        reader.problem("unknown-word", message, reader.place_of(key))
    return listed


def _as_ours(name: str, command: Command) -> Method:
    found = tuple(Parameter(each.name, each.default) for each in arguments(command))
    return Method(name, command, found, tuple(each.name for each in found), "plain")


def _parameters(reader: Reader, key: Key[tuple[str, ...]]) -> tuple[Parameter, ...]:
    found = []
    for text in reader.get(key):
        match = _PARAMETER.match(text)
        if match is None:
            message = f"{reader.what} has the parameter {text}; write name or name=default"
            reader.problem("bad-name", message, reader.place_of(key))
        else:
            found.append(Parameter(match[1], match[2] or ""))
    return tuple(found)
