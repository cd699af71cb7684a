"""The commands of a family."""

from __future__ import annotations

from cobotwire_codegen.build.fields import build_field, build_forms
from cobotwire_codegen.build.parts import FamilyParts, Parts
from cobotwire_codegen.build.read_back import build_read_back, build_tries
from cobotwire_codegen.build.text import build_text
from cobotwire_codegen.build.types import Types, disputes
from cobotwire_codegen.errors import Place, Problem
from cobotwire_codegen.load import Node
from cobotwire_codegen.model import ROLES, SAFETY, Command, Family, Form
from cobotwire_codegen.reader import Reader


def build_family(
    family: FamilyParts, parts: Parts, types: Types, deadline_ms: int, problems: list[Problem]
) -> Family:
    """A family with its commands."""
    acks = _Acks(parts, types, problems)
    commands = [
        _command(name, place, node, parts, types, acks, deadline_ms, problems)
        for name, (place, node) in family.commands.items()
    ]
    return Family(family.place, family.name, family.title, family.doc, tuple(commands))


class _Acks:
    """The edition's rule for commands that nothing else answers."""

    def __init__(self, parts: Parts, types: Types, problems: list[Problem]) -> None:
        self.forms: tuple[Form, ...] = ()
        self._except: list[str] = []
        if parts.acks is None:
            return
        reader = Reader(parts.acks, "the acks", problems)
        field = reader.required("field")
        self._except = reader.names("except")
        reader.text("why")
        known = set(parts.commands())
        for name in self._except:
            if name not in known:
                reader.problem("unknown-command", f"there is no command {name}")
        if field is not None:
            # One byte, or a bare frame: both are seen on the line.
            self.forms = ((build_field(field, "reply", reader, types),), ())
        reader.done()

    def of(self, name: str) -> tuple[Form, ...]:
        """The acknowledgement of a command that has no other reply."""
        return () if name in self._except else self.forms


def _command(
    name: str,
    place: Place,
    node: Node,
    parts: Parts,
    types: Types,
    acks: _Acks,
    deadline_ms: int,
    problems: list[Problem],
) -> Command:
    reader = Reader(node, f"the command {name}", problems)
    replies = build_forms(reader, "reply", types)
    text = build_text(reader, "reply_text")
    ack = reader.yes("ack")
    if not replies and text is None:
        replies = acks.of(name)
        ack = bool(replies)
    command = Command(
        place=place,
        id=reader.integer("id"),
        name=name,
        title=reader.text("title"),
        doc=reader.text("doc"),
        safety=reader.one_of("safety", SAFETY),
        role=reader.one_of("role", ROLES, ""),
        source=reader.lines("source"),
        deadline_ms=reader.positive("deadline_ms", deadline_ms),
        requests=build_forms(reader, "request", types) or ((),),
        replies=replies,
        ack=ack,
        alias=reader.text("alias", ""),
        shares_id=tuple(reader.names("shares_id")),
        text=text,
        request_text=build_text(reader, "request_text"),
        read_by=build_read_back(reader),
        tries=build_tries(reader),
        agrees_with=tuple(reader.names("agrees_with")),
        notes=reader.texts("notes"),
        disputed=disputes(reader),
        changes=tuple(parts.changes.get(name, ())),
    )
    reader.done()
    return command
