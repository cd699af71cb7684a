"""A setting and the query that reads it back: what is sent, and what must be reported."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from cobotwire.conformance.device.requests import as_row, gentle_values, limits_of, requests
from cobotwire.conformance.mistakes import Pair, likely_mistake
from cobotwire.conformance.places import numbers_of
from cobotwire.conformance.samples.physical import setting_values, takes_whole
from cobotwire.conformance.samples.raw import Limits
from cobotwire.protocol.fields import named_fields
from cobotwire.protocol.messages import Reply, Request
from cobotwire.protocol.table import Command, Field, Number, Table, Variant

# Both values are multiples of the wire's step, so only floating-point errors are tolerated.
EXACT = 1e-6


@dataclass(frozen=True, slots=True)
class Setting:
    """One variant of a command, and the variant of the query that reports what it has set.

    ``pairs`` are the reply's fields with the arguments that they report. The query's arguments, if
    it has any, choose what is read, such as a joint; the setting has them too.
    """

    command: Command
    variant: Variant
    query: Command
    query_variant: Variant
    pairs: tuple[tuple[str, str], ...]

    @property
    def queries(self) -> list[Request[Any]]:
        """The queries of all that can be set: each joint, pin or register in turn."""
        given = {field.name: field for field in self.variant.fields}
        fields = self.query_variant.fields
        fields = tuple(f if f.const is not None else given[f.name] for f in fields)
        return requests(self.query, Variant(fields), limits=self._limits)

    @property
    def _limits(self) -> Limits:
        """The limits of the arguments whose legal numbers are not all harmless."""
        return limits_of(self.command, self.variant)

    def again(self, query: Request[Any], reply: Reply[Any], speed: int = 1) -> Request[Any]:
        """Return the request that sets what a query has reported."""
        wanted = {name: self._as_sent(name, v) for name, v in self._reported(reply).items()}
        return self._request(query, wanted, speed)

    def _as_sent(self, name: str, value: Any) -> Any:
        """Return a reported value as a request takes it: 165 for 165.0, if it is a whole number."""
        if not isinstance(value, float) or self._field(name).cases[0].numbers[0].real:
            return value
        return round(value)

    def samples(self, query: Request[Any], old: Reply[Any], speed: int = 1) -> list[Request[Any]]:
        """Return requests that reveal mistakes: ends, both signs, and a difference in each byte.

        They set what ``query`` reads, where ``old`` was read.
        """
        return [self._request(query, values, speed) for values in self._values(query, old)]

    def _values(self, query: Request[Any], old: Reply[Any]) -> list[dict[str, Any]]:
        def numbers(name: str) -> list[tuple[Number, Number]]:
            return list(zip(self._numbers(name, query), self._reported_as(name)))

        return setting_values(self.variant, self._reported(old), numbers)

    def _reported(self, reply: Reply[Any]) -> dict[str, Any]:
        """Return what a reply reports, by argument and in the units of the wire."""
        fields = reply.fields
        return {argument: fields[name] for name, argument in self.pairs}

    def _request(self, query: Request[Any], values: Mapping[str, Any], speed: int) -> Request[Any]:
        """Return the request that sets ``values`` of what ``query`` reads.

        Its other arguments are speeds as given, and the values that do the least.
        """
        speeds = {f.name: speed for f in self.variant.fields if _is_speed(f) and not f.many}
        return self.command.request_type.from_fields(
            {**gentle_values(self.variant), **speeds, **query.fields, **values}
        )

    def differences(
        self,
        wanted: Request[Any],
        reply: Reply[Any] | None,
        near: Mapping[str, float] | None = None,
    ) -> list[str]:
        """Describe each part of a reply that is not as requested, with both values.

        ``near`` holds the tolerance by unit.
        """
        if reply is None:
            return ["nothing was reported"]
        found, sent, pairs = [], wanted.fields, list[Pair]()
        for name, value in self._reported(reply).items():
            if self.command.request_text is None and takes_whole(self._field(name)):
                if sent[name] != value:
                    found.append(f"{name}: set {sent[name]!r}, read {value!r}")
                continue
            for at, (want, have) in enumerate(zip(as_row(sent[name]), as_row(value))):
                most = (near or {}).get(self._unit(name, at), EXACT)
                if want != have and not (_number(want) and abs(want - have) <= most):
                    found.append(f"{self._label(name, at)}: set {want}, read {have}")
                if _number(want):
                    pairs.append(self._pair(name, at, want, have, most))
        mistake = likely_mistake(pairs) if len(pairs) > 1 else ""
        return [*found, mistake] if mistake else found

    def _pair(self, name: str, at: int, want: float, have: float, near: float) -> Pair:
        """Return a number that was set, and the one that was read."""
        number = self._field(name).cases[0].numbers[at]
        label = f"{name}.{number.name}" if number.name else name
        return Pair(label, want, have, near, number)

    def _label(self, name: str, at: int) -> str:
        """Return the name of a field and its part, with the unit."""
        if self.command.request_text is not None:
            return name
        number = self._field(name).cases[0].numbers[at]
        part = f"{name}.{number.name}" if number.name else name
        return f"{part} ({number.unit})" if number.unit else part

    def _unit(self, name: str, at: int) -> str:
        text = self.command.request_text is not None
        return "" if text else self._field(name).cases[0].numbers[at].unit

    def _field(self, name: str) -> Field:
        return next(field for field in self.variant.fields if field.name == name)

    def _numbers(self, name: str, query: Request[Any]) -> tuple[Number, ...]:
        chosen = query.fields
        fields = enumerate(self.variant.fields)
        picked = {at: chosen[field.name] for at, field in fields if field.name in chosen}
        return numbers_of(self._field(name), picked)

    def _reported_as(self, name: str) -> tuple[Number, ...]:
        reported = next(reported for reported, argument in self.pairs if argument == name)
        rows = [
            field.cases[0].numbers
            for variant in self.query.reply
            for field in variant.fields
            if field.name == reported
        ]
        # A reply may have a narrow and a wide variant; the arm uses the one with enough room.
        return max(rows, key=lambda numbers: numbers[0].maximum)


def settings_of(table: Table, command: Command) -> list[Setting]:
    """Return the variants of a command that a query reads back; none if its effect is fixed."""
    back = command.read_by
    if back is None or has_fixed_effect(command):
        return []
    query = next((each for each in table.commands if each.name == back.query), None)
    found: list[Setting] = []
    if query is None:
        return found
    for variant in _of_corner_sizes(command.request):
        query_variant = _query_variant(query, variant)
        pairs = _pairs(command, variant, query)
        if query_variant is not None and pairs:
            found.append(Setting(command, variant, query, query_variant, pairs))
    return found


def _of_corner_sizes(variants: tuple[Variant, ...]) -> Iterator[Variant]:
    """Yield the variants; of sizes that vary, only the least and the most elements."""
    for variant in variants:
        sized = [field for field in variant.fields if field.sizes and not field.counts]
        if all(field.dimensions[0] in (field.sizes or ()) for field in sized):
            yield variant


def has_fixed_effect(command: Command) -> bool:
    """Return whether a query reports a fixed value after a command, such as power on."""
    back = command.read_by
    return back is not None and any(not isinstance(value, str) for _, value in back.fields)


def _query_variant(query: Command, variant: Variant) -> Variant | None:
    """Return the fullest variant of the query with all its arguments among the setting's."""
    names = {field.name for field in variant.fields}
    fitting = [f for f in query.request if set(named_fields((f,))) <= names]
    return max(fitting, key=lambda f: len(f.fields), default=None)


def _pairs(command: Command, variant: Variant, query: Command) -> tuple[tuple[str, str], ...]:
    assert command.read_by is not None
    if command.read_by.fields:
        return tuple((name, str(argument)) for name, argument in command.read_by.fields)
    fields = named_fields(query.reply)
    reported = {name for name, (one, *_) in fields.items() if not one.echo and not one.counts}
    return tuple((name, name) for name in named_fields((variant,)) if name in reported)


def _is_speed(field: Field) -> bool:
    return any(number.unit == "percent" for number in field.cases[0].numbers[:1])


def _number(value: Any) -> bool:
    return isinstance(value, int | float)
