"""What the layer offers: the maker's classes and methods, and which of ours they call."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire_codegen.model import Command, Edition


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a method; ``default`` is a literal, or empty."""

    name: str
    default: str


@dataclass(frozen=True, slots=True)
class Method:
    """A method of the library.

    ``command`` is the command that it calls; ``passes`` are the parameters and the numbers that it
    passes; ``result`` is how our result is converted. ``address`` is the parameter that selects the
    device; ``lacks`` are parameters that cannot be sent.
    """

    name: str
    command: Command
    parameters: tuple[Parameter, ...]
    passes: tuple[str, ...]
    result: str
    address: str = ""
    lacks: tuple[str, ...] = ()
    ranges: tuple[tuple[str, str, str], ...] = ()

    @property
    def takes(self) -> frozenset[str]:
        """The names of its parameters."""
        return frozenset(parameter.name for parameter in self.parameters)

    @property
    def may_be_quiet(self) -> bool:
        """Whether a caller may choose not to wait for the acknowledgement."""
        return QUIET in self.takes


@dataclass(frozen=True, slots=True)
class LibraryClass:
    """A class of the library.

    ``edition`` is the edition on ``ports``, and ``elsewhere`` the edition on all other ports; they
    may be equal. ``like`` is the class that it inherits from; empty without one. ``one_way``
    says what its one-way requests return, and when. ``absent`` are its names that have no
    counterpart, each with the reason.
    """

    name: str
    module: str
    doc: str
    edition: Edition
    elsewhere: Edition
    ports: tuple[str, ...]
    opens: str
    constructor: tuple[Parameter, ...]
    like: str
    helpers: tuple[str, ...]
    one_way: str
    absent: tuple[tuple[str, str], ...]
    methods: tuple[Method, ...]


@dataclass(frozen=True, slots=True)
class Library:
    """The maker's library; ``name`` has its version.

    ``absent`` are its public names that have no counterpart, each with the reason.
    """

    name: str
    absent: tuple[tuple[str, str], ...]
    classes: tuple[LibraryClass, ...]


# The result of a motion that is waited for.
ENDED = "ended"
# The parameter that says whether a method waits for its acknowledgement.
QUIET = "_async"
