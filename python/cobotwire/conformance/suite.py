"""Test cases, and the suite that lists them in an explicit order; the same for every subject."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, TypeVar

from cobotwire.conformance.report import Kind

if TYPE_CHECKING:
    # Every pytest run imports this module with the plugin, and must not load the tables' records.
    from cobotwire.protocol.table import Command, Table

# Exercises or checks the test cases of a group; each kind of subject has its own type.
Body = TypeVar("Body", covariant=True)

# Returns what the body of a group needs to know of a command; None if it does not run for it.
Selects = Callable[["Table", "Command"], object]


def every_command(command: Command) -> bool:
    """Return True: by default, a test case applies to every command."""
    return True


@dataclass(frozen=True, slots=True)
class TestCase:
    """One requirement of the protocol, on which a run gives a verdict for each command.

    ``id`` is stable, because reports are compared by it. ``purpose`` states the requirement in one
    sentence. ``source`` says where it comes from; if a line of the spec states it, reports show
    that line instead. ``applies`` selects the commands on which it can be checked. ``timed``: its
    verdict depends on time, so a busy host may cause a failure.
    """

    # pytest would take the class for a class of tests.
    __test__ = False

    id: str
    purpose: str
    source: str = ""
    applies: Callable[[Command], bool] = every_command
    timed: bool = False


# Every suite has this one: a run may have a file of known failures.
EXPECTED_FAILURE = TestCase(
    "expected-failure",
    "Everything that the file of known failures names fails.",
    "docs/conformance.md",
)


@dataclass(frozen=True, slots=True)
class Group(Generic[Body]):
    """Test cases that one body exercises or checks together.

    ``selects`` picks the commands that the body runs for; without it the body runs once, for the
    connection as a whole. ``permission`` is needed in addition to the permission for the command's
    safety class. ``sends`` and ``subject`` are texts for the catalogue: what the tester sends, and
    which commands ``selects`` picks. With ``declared`` the body checks the subject's conformance
    statement: it runs only if there is one, for the commands that the statement declares absent.
    """

    name: str
    cases: tuple[TestCase, ...]
    body: Body
    selects: Selects | None = None
    permission: frozenset[str] = frozenset()
    sends: str = ""
    subject: str = ""
    declared: bool = False


@dataclass(frozen=True, slots=True)
class Suite(Generic[Body]):
    """All test cases for one kind of subject; groups run in this order."""

    kind: Kind
    groups: tuple[Group[Body], ...]

    @property
    def cases(self) -> tuple[TestCase, ...]:
        """Every test case once, in the order of the groups."""
        cases = (case for group in self.groups for case in group.cases)
        return tuple(dict.fromkeys((*cases, EXPECTED_FAILURE)))
