"""A setting and the query that reads it: what is asked, what is set, what must be told."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from cobotwire.conformance.device.distinct import choices_of, spread
from cobotwire.conformance.device.values import Limits, gentle, numbers_of, requests
from cobotwire.table import Command, Field, Layout, Number, Table

Values = dict[str, Any]
# Texts that differ in every place, with what a name may hold.
TEXTS = (("cobot 1", "pass-word 2"), ("A", "B8"))
# Values that went through the wire both ways are the same multiple of its step.
EXACT = 1e-6


@dataclass(frozen=True, slots=True)
class Readable:
    """One form of a command, and the form of the query that tells what it set.

    ``pairs`` are the reply's fields with the arguments that they repeat; ``keys`` the arguments
    that choose what is read, such as a joint.
    """

    command: Command
    form: Layout
    query: Command
    asked: Layout
    pairs: tuple[tuple[str, str], ...]

    @property
    def keys(self) -> list[Values]:
        """What can be set: each joint, pin or register, one after the other."""
        fields = {field.name: field for field in self.form.fields}
        layout = Layout(tuple(fields[field.name] for field in self.asked.fields))
        names = [field.name for field in layout.fields]
        return [dict(zip(names, values)) for values in requests(layout, {}, self.limits)]

    @property
    def limits(self) -> Limits:
        """What may be sent, by argument, where not every legal number is harmless."""
        names = {field.name for field in self.form.fields}
        for tried in self.command.tries:
            if {name for name, _ in tried} <= names:
                return dict(tried)
        return {}

    def question(self, key: Values) -> list[Any]:
        """The arguments of the query for a key."""
        return [key[field.name] for field in self.asked.fields]

    def told(self, fields: Mapping[str, Any]) -> Values:
        """What a reply says, by the names of the setting's arguments."""
        return {argument: fields[name] for name, argument in self.pairs}

    def request(self, key: Values, values: Values) -> tuple[list[Any], Values]:
        """Arguments and text of the request that sets ``values``."""
        if self.command.request_text is not None:
            return [], values
        return [{**key, **values}[field.name] for field in self.form.fields], {}

    def tries(self, key: Values, old: Values) -> list[Values]:
        """Values that tell mistakes apart: the ends, both signs, and what differs in each byte."""
        names = [argument for _, argument in self.pairs]
        if self.command.request_text is not None:
            return [dict(zip(names, texts)) for texts in TEXTS]
        fields = [self._field(name) for name in names]
        closed = [choices_of(field) for field in fields]
        if len(fields) == 1 and closed[0]:
            return [{names[0]: value} for value in closed[0]]
        rows = [list(zip(self._numbers(name, key), self._reported(name))) for name in names]
        present = [_row(old[name]) for name in names]
        return [
            {
                name: row if field.many else row[0]
                for name, field, row in zip(names, fields, variant)
            }
            for variant in spread(rows, present)
        ]

    def rest(self, speed: int) -> Values:
        """The arguments that are neither key nor value: speeds as given, else what does least."""
        told = {argument for _, argument in self.pairs}
        mild = dict(zip((field.name for field in self.form.fields), gentle(self.form)))
        speeds = {f.name: speed for f in self.form.fields if _is_speed(f) and not f.many}
        return {name: value for name, value in {**mild, **speeds}.items() if name not in told}

    def differences(
        self, wanted: Values, got: Values | None, near: Mapping[str, float] | None = None
    ) -> list[str]:
        """In words: each part that is not what it should be, with both values.

        ``near`` says by unit how far apart they may be.
        """
        if got is None:
            return ["nothing was told"]
        found = []
        for _, name in self.pairs:
            for at, (want, have) in enumerate(zip(_row(wanted[name]), _row(got[name]))):
                most = (near or {}).get(self._unit(name, at), EXACT)
                if want != have and not (_number(want) and abs(want - have) <= most):
                    found.append(f"{self._label(name, at)}: set {want}, read {have}")
        return found

    def _label(self, name: str, at: int) -> str:
        """A field's name with its part's, and the unit."""
        if self.command.request_text is not None:
            return name
        number = self._field(name).cases[0].numbers[at]
        part = f"{name}.{number.name}" if number.name else name
        return f"{part} ({number.unit})" if number.unit else part

    def _unit(self, name: str, at: int) -> str:
        text = self.command.request_text is not None
        return "" if text else self._field(name).cases[0].numbers[at].unit

    def _field(self, name: str) -> Field:
        return next(field for field in self.form.fields if field.name == name)

    def _numbers(self, name: str, key: Values) -> tuple[Number, ...]:
        places = {field.name: at for at, field in enumerate(self.form.fields)}
        selected = {places[argument]: value for argument, value in key.items()}
        return numbers_of(self._field(name), selected)

    def _reported(self, name: str) -> tuple[Number, ...]:
        told = next(reported for reported, argument in self.pairs if argument == name)
        rows = [
            field.cases[0].numbers
            for form in self.query.reply
            for field in form.fields
            if field.name == told
        ]
        # A reply may have a narrow form and a wide one; the arm takes the one that has room.
        return max(rows, key=lambda numbers: numbers[0].maximum)


def readable(table: Table, command: Command) -> list[Readable]:
    """The forms of a command whose arguments a query tells; none where its effect is fixed."""
    back = command.read_by
    if back is None or any(not isinstance(said, str) for _, said in back.fields):
        return []
    query = table.command(back.query)
    found = []
    for form in command.request:
        asked = _question(query, form)
        pairs = _pairs(command, form, query)
        if asked is not None and pairs:
            found.append(Readable(command, form, query, asked, pairs))
    return found


def _question(query: Command, form: Layout) -> Layout | None:
    """The fullest form of the query whose arguments are all among the setting's."""
    names = {field.name for field in form.fields}
    fitting = [f for f in query.request if {field.name for field in f.fields} <= names]
    return max(fitting, key=lambda f: len(f.fields), default=None)


def _pairs(command: Command, form: Layout, query: Command) -> tuple[tuple[str, str], ...]:
    assert command.read_by is not None
    if command.read_by.fields:
        return tuple((name, str(said)) for name, said in command.read_by.fields)
    told = {field.name for form in query.reply for field in form.fields if not field.echo}
    return tuple((f.name, f.name) for f in form.fields if f.name in told)


def _row(value: Any) -> tuple[Any, ...]:
    return tuple(value) if isinstance(value, tuple | list) else (value,)


def _is_speed(field: Field) -> bool:
    return field.cases[0].numbers[0].unit == "percent"


def _number(value: Any) -> bool:
    return isinstance(value, int | float)
