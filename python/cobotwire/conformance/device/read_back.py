"""A setting and the query that reads it back: the request to send, and the reply to expect."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from cobotwire.conformance.device.device import Device, NotSupported
from cobotwire.conformance.device.requests import (
    arguments_of,
    as_row,
    gentle_values,
    limits_of,
    requests,
)
from cobotwire.conformance.device.selection import reporter, reporters, stated_effect
from cobotwire.conformance.located import numbers_of
from cobotwire.conformance.mistakes import Pair, likely_mistake
from cobotwire.conformance.samples.physical import setting_values, takes_whole
from cobotwire.conformance.samples.raw import Limits
from cobotwire.protocol.effects import Cases, Stores
from cobotwire.protocol.fields import named_fields
from cobotwire.protocol.messages import Reply, Request
from cobotwire.protocol.table import Command, Field, Number, Table, Variant

# Both values are multiples of the wire's step, so only floating-point errors are tolerated.
EXACT = 1e-6


@dataclass(frozen=True, slots=True)
class Setting:
    """One variant of a command, and the variant of the query that reports what it has set.

    ``pairs`` are the reply's fields with the arguments that they report. The query's arguments, if
    it has any, choose what is read, such as a joint; the setting has them too. If the query reports
    several numbers, ``part`` has the argument that names the one which is set, and ``place`` is its
    index if one field holds them all.
    """

    command: Command
    variant: Variant
    query: Command
    query_variant: Variant
    pairs: tuple[tuple[str, str], ...]
    part: tuple[tuple[str, int], ...] = ()
    place: int | None = None

    @property
    def queries(self) -> list[Request[Any]]:
        """The queries of all that can be set: each joint, pin or register in turn."""
        own = {field.name: field for field in self.variant.fields}
        fields = self.query_variant.fields
        fields = tuple(f if f.const is not None else own[f.name] for f in fields)
        # An argument that selects what is stored keeps its value.
        part = {name: (raw,) for name, raw in self.part}
        return requests(self.query, Variant(fields), limits={**self._limits, **part})

    @property
    def _limits(self) -> Limits:
        """The limits of the arguments with legal numbers that may do harm."""
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

        They set what ``query`` reads; ``old`` is its present reply.
        """
        return [self._request(query, values, speed) for values in self._values(query, old)]

    def _values(self, query: Request[Any], old: Reply[Any]) -> list[dict[str, Any]]:
        def numbers(name: str) -> list[tuple[Number, Number]]:
            return list(zip(self._numbers(name, query), self._reported_as(name)))

        return setting_values(self.variant, self._reported(old), numbers)

    def _reported(self, reply: Reply[Any]) -> dict[str, Any]:
        """Return what a reply reports, by argument and in the units of the wire."""
        fields = {argument: reply.fields[name] for name, argument in self.pairs}
        return {name: v if self.place is None else v[self.place] for name, v in fields.items()}

    def _request(self, query: Request[Any], values: Mapping[str, Any], speed: int) -> Request[Any]:
        """Return the request that sets ``values`` of what ``query`` reads.

        Its speeds are ``speed``, and its other arguments are those that do the least.
        """
        speeds = {f.name: speed for f in self.variant.fields if _is_speed(f) and not f.many}
        return self.command.request_type.from_fields(
            {**gentle_values(self.variant), **speeds, **query.fields, **dict(self.part), **values}
        )

    def differences(
        self,
        wanted: Request[Any],
        reply: Reply[Any] | None,
        near: Mapping[str, float] | None = None,
    ) -> list[str]:
        """Describe each number of a reply that is not as requested, with both values.

        ``near`` holds the tolerance by unit.
        """
        if reply is None:
            return ["nothing was reported"]
        found, sent, pairs = [], wanted.fields, list[Pair]()
        for name, value in self._reported(reply).items():
            if self.command.request_text is not None or takes_whole(self._field(name)):
                if sent[name] != value:
                    found.append(f"{name}: set {sent[name]!r}, read {value!r}")
                continue
            numbers = self._field(name).cases[0].numbers
            for number, want, have in zip(numbers, as_row(sent[name]), as_row(value)):
                part = f"{name}.{number.name}" if number.name else name
                pair = Pair(part, want, have, (near or {}).get(number.unit, EXACT), number)
                pairs.append(pair)
                if pair.wrong:
                    unit = f" ({number.unit})" if number.unit else ""
                    found.append(f"{part}{unit}: set {want}, read {have}")
        mistake = likely_mistake(pairs) if len(pairs) > 1 else ""
        return [*found, mistake] if mistake else found

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
        row = max(rows, key=lambda numbers: numbers[0].maximum)
        return row if self.place is None else row[self.place : self.place + 1]


@dataclass(frozen=True, slots=True)
class SavedValue:
    """The value that a query read, and the request that sets it again.

    ``obstacle`` says why that request cannot be sent; empty: it can.
    """

    setting: Setting
    query: Request[Any]
    before: Reply[Any]
    old: Request[Any]
    obstacle: str = ""

    def __str__(self) -> str:
        part = ", ".join(f"{name}={value}" for name, value in self.setting.part)
        return f"{self.old.command}({part or arguments_of(self.query)})"

    @property
    def index(self) -> tuple[Any, ...]:
        """The key of a setting: settings with equal keys differ only in their encoding."""
        effect = stated_effect(self.setting.command)
        at = effect.at if isinstance(effect, Stores) else ()
        return tuple(self.old.fields[name] for name in at) or (self.query, self.setting.part)

    @property
    def samples(self) -> list[Request[Any]]:
        """Requests that set values which reveal mistakes."""
        return self.setting.samples(self.query, self.before)

    @property
    def others(self) -> list[Request[Any]]:
        """Requests that change the value; the one nearest to zero comes first."""
        return [sample for sample in reversed(self.samples) if sample != self.old]


def saved_value(device: Device, setting: Setting, query: Request[Any]) -> SavedValue | None:
    """Read one joint, pin or register; None if no valid reply comes."""
    before = device.read(query)
    if before is None:
        return None
    old = setting.again(query, before)
    return SavedValue(setting, query, before, old, device.cannot_send(old))


def restorable_value(
    device: Device, setting: Setting, query: Request[Any], *, or_lost: bool = False
) -> SavedValue:
    """Read one joint, pin or register that can be restored; with ``or_lost`` it need not be.

    Raises:
        NotSupported: no valid reply comes, or the value cannot be set again.
    """
    saved = saved_value(device, setting, query)
    if saved is None:
        raise NotSupported(f"{query.command} reports nothing, so nothing can be read back")
    if saved.obstacle and not or_lost:
        raise NotSupported(f"the present value could not be set again: {saved.obstacle}")
    return saved


def settings_of(table: Table, command: Command) -> list[Setting]:
    """Return the variants of a command that a query reads back; none if its effect is fixed."""
    back = command.read_by
    if back is None:
        return list(_parts(table, command)) if command.request else []
    if fixed_effect(table, command):
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


def _parts(table: Table, command: Command) -> Iterator[Setting]:
    """Yield the settings of a command that sets one of several numbers, which a query reports.

    An argument names one number of a row, or is the selector of what is stored.
    """
    effect, variant = stated_effect(command), command.request[0]
    if isinstance(effect, Cases):
        for raw, case in effect.cases.items():
            if not isinstance(case, Stores):
                continue
            for argument, state in case.values.items():
                found = next((each for each in reporters(table, state) if each.at == case.at), None)
                if found:
                    query, part = found.query, ((effect.selector, raw),)
                    pairs = ((found.field, argument),)
                    yield Setting(command, variant, query, query.request[0], pairs, part)
    if isinstance(effect, Stores) and len(effect.values) == len(effect.at) == 1:
        [(argument, state)], [at] = effect.values.items(), effect.at
        if found := reporter(table, state):
            most = named_fields((variant,))[at][0].cases[0].numbers[0].maximum
            row = named_fields(found.query.reply)[found.field][0].cases[0].numbers
            for place in range(min(len(row), most)):
                query, part = found.query, ((at, place + 1),)
                pairs = ((found.field, argument),)
                yield Setting(command, variant, query, query.request[0], pairs, part, place)


def _of_corner_sizes(variants: tuple[Variant, ...]) -> Iterator[Variant]:
    """Yield the variants in which each list of varying size is at its shortest or longest."""
    for variant in variants:
        sized = [field for field in variant.fields if field.sizes and not field.counts]
        if all(field.dimensions[0] in (field.sizes or ()) for field in sized):
            yield variant


class Fixed(NamedTuple):
    """A query that reports the fixed effect of a command, such as power on, and what it reports."""

    query: Command
    field: str
    value: int

    def for_part(self, part: Request[Any]) -> Request[Any]:
        """Return the query about the joint that a request names; about all if it names none."""
        known = self.query.argument_names
        fields = {name: value for name, value in part.fields.items() if name in known}
        return self.query.request_type.from_fields(fields)

    def read(self, device: Device, query: Request[Any]) -> int:
        """Return what the query reports now.

        Raises:
            NotSupported: no valid reply comes.
        """
        return int(getattr(device.require(query), self.field))


def fixed_effect(table: Table, command: Command) -> Fixed | None:
    """Return what a query reports after a command, if that is fixed."""
    back = command.read_by
    if back is not None:
        for field, value in back.fields:
            if not isinstance(value, str):
                return Fixed(table.command(back.query), field, int(value))
    return None


def setter_of(table: Table, query: Command, value: int) -> Command | None:
    """Return the command that makes a query report ``value``; None if none does."""
    for command in table.commands:
        fixed = fixed_effect(table, command)
        if fixed and fixed.query.name == query.name and fixed.value == value:
            return command
    return None


def _query_variant(query: Command, variant: Variant) -> Variant | None:
    """Return the query variant with the most arguments that the setting has, too, and no others."""
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
