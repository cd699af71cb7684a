"""An edition with its errata and its vectors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Literal

from cobotwire_codegen.errors import Place, nearest
from cobotwire_codegen.model.commands import Command, Family
from cobotwire_codegen.model.effects import State
from cobotwire_codegen.model.facts import Change, Lines, Observation
from cobotwire_codegen.model.frame import Frame
from cobotwire_codegen.model.robot import Robot
from cobotwire_codegen.model.shapes import Type
from cobotwire_codegen.model.wires import Wire


@dataclass(frozen=True, slots=True)
class Erratum:
    """A place where the document is wrong or contradicts itself, and how it is read."""

    place: Place
    lines: Lines
    kind: str
    commands: tuple[str, ...]
    example: int | None
    says: str
    read: str
    why: str


@dataclass(frozen=True, slots=True)
class Derivation:
    """What a vector of a delta was derived from: the edition, and its frame and values there."""

    edition: str
    frame: bytes
    values: tuple[tuple[str, object], ...]


# Values by field.
Limits = tuple[tuple[str, tuple[object, ...]], ...]


@dataclass(frozen=True, slots=True)
class Vector:
    """A frame with the values that it carries. ``example`` is its number in the document, from 1.

    With ``derived``, the frame was computed from a vector of the base; it is not evidence itself.
    ``accepted`` and ``refused`` hold, for some fields, values that are legal in place of the
    field's own, and values that are not.
    """

    place: Place
    name: str
    example: int | None
    line: int | None
    command: str
    direction: Literal["request", "reply"]
    printed: bytes | None
    verdict: str
    frame: bytes | None
    text: str | None
    values: tuple[tuple[str, object], ...]
    says: str
    rejected: tuple[str, int] | None
    derived: Derivation | None = None
    accepted: Limits = ()
    refused: Limits = ()


@dataclass(frozen=True)  # without slots, for the cached properties
class Edition:
    """One edition of a protocol."""

    place: Place
    name: str
    class_name: str
    title: str
    doc: str
    document: str
    firmware: str
    base: str
    joints: int
    robot: Robot
    frame: Frame
    wires: tuple[Wire, ...]
    types: tuple[Type, ...]
    families: tuple[Family, ...]
    errata: tuple[Erratum, ...]
    vectors: tuple[Vector, ...]
    changes: tuple[Change, ...]
    states: tuple[State, ...] = ()
    """The state that the arm keeps."""
    gone: tuple[tuple[str, str], ...] = ()
    """Commands of the base that this edition removes or renames, with a hint that says where."""
    bases: tuple[str, ...] = ()
    """The names of the base, of its base, and so on."""
    root: Path = field(default=Path(), compare=False, repr=False)
    """The folder to which the file names of places are relative."""
    observed: tuple[Observation, ...] = ()
    """What real arms showed."""

    def no_command(self, name: str) -> str:
        """Return the error message for an unknown command."""
        hint = dict(self.gone).get(name) or nearest(name, (c.name for c in self.commands))
        return f"there is no command {name}{hint}"

    @cached_property
    def commands(self) -> tuple[Command, ...]:
        """All commands, family by family."""
        return tuple(command for family in self.families for command in family.commands)

    @cached_property
    def by_name(self) -> Mapping[str, Command]:
        """The commands by name."""
        return {command.name: command for command in self.commands}
