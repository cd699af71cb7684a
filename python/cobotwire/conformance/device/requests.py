"""The typed requests that a run sends."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cobotwire.conformance.samples.physical import arguments
from cobotwire.conformance.samples.physical import revealing as revealing
from cobotwire.conformance.samples.raw import Known as Known
from cobotwire.conformance.samples.raw import Limits, harmless_values, plainest
from cobotwire.conformance.samples.raw import units as units
from cobotwire.protocol.messages import Reply, Request
from cobotwire.protocol.table import Command, Variant


def as_row(value: Any) -> tuple[Any, ...]:
    """Return the numbers that a field holds, whether it holds one number or several."""
    return tuple(value) if isinstance(value, tuple | list) else (value,)


def request_of(command: Command, *values: Any) -> Request[Any]:
    """Return the typed request for values in the order and the units of the wire.

    Its variant is the first one with that number of fields.
    """
    variant = next(v for v in command.request if len(v.fields) == len(values))
    return _typed(command, {field.name: value for field, value in zip(variant.fields, values)})


def _typed(command: Command, fields: Mapping[str, Any]) -> Request[Any]:
    return command.request_type.from_fields(
        {name: tuple(v) if isinstance(v, list) else v for name, v in fields.items()}
    )


def values_text(reply: Reply[Any] | None) -> str:
    """Return the values of a reply as a person writes them: ``joint 1, angle 20.0``."""
    if reply is None:
        return "no reply"
    return ", ".join(f"{name} {value}" for name, value in reply.fields.items())


def flag_text(query: Command, value: bool | None) -> str:
    """Return what a query reports, by the name of the value if it has one: FILLED; else True."""
    if value is None:
        return "no valid reply"
    field = query.reply[0].fields[-1]
    return dict(zip(field.choices, field.labels)).get(int(value), str(value))


def arguments_of(request: Request[Any]) -> str:
    """Return the arguments of a request as a person writes them: ``joint=1, angle=20.0``."""
    return ", ".join(f"{name}={value}" for name, value in request.fields.items())


def requests(
    command: Command, variant: Variant, known: Known | None = None, limits: Limits | None = None
) -> list[Request[Any]]:
    """Return requests of a variant with harmless values: each field in turn takes a few."""
    values = harmless_values(variant, known or {}, limits or {})
    return [_typed(command, arguments(variant, raw_values)) for raw_values in values]


def limits_of(command: Command, variant: Variant) -> Limits:
    """Return the limits of the arguments of a variant with legal numbers that may do harm."""
    names = {field.name for field in variant.fields}
    for samples in command.samples:
        if {name for name, _ in samples} <= names:
            return dict(samples)
    return {}


def harmless(command: Command) -> list[Request[Any]]:
    """Return requests of a command's shortest variant, within the limits of the edition."""
    return requests(command, command.request[-1], limits=dict(*command.samples[-1:]))


def gentle(command: Command) -> Request[Any]:
    """Return the request that does the least: one step from zero, in the shortest variant."""
    text = command.request_text
    words = dict.fromkeys(text.fields, "cobot") if text else {}
    return _typed(command, gentle_values(command.request[-1]) | words)


def gentle_values(variant: Variant) -> dict[str, Any]:
    """Return the arguments that do the least: the numbers nearest to one step from zero."""
    return arguments(variant, plainest(variant, near=1))
