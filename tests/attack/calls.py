"""What users call, and the values that the arm puts into its replies.

The arm numbers its replies, so that a result shows which request it belongs to. Each one-way
request carries a number of its own, so that a frame at the arm shows which call sent it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from random import Random
from typing import Any, NamedTuple

from cobotwire.protocol.table import Command, Table

Values = Sequence[Any]


class Kind(NamedTuple):
    """A command that users call.

    Attributes:
        name: the command's name.
        weight: how often it is called, relative to the others.
        arguments: draws the arguments of a call, given a number that no other call has.
        reply: returns the fields of reply number ``n``; None: it is a one-way request.
    """

    name: str
    weight: int
    arguments: Callable[[Random, int], Values]
    reply: Callable[[int], dict[str, Any]] | None = None


def _word(number: int) -> int:
    return number % 30000


def _angles(number: int) -> list[float]:
    return [number % 30000 / 100, number // 30000 / 100, 1.0, 2.0, 3.0, 4.0]


def _bit(number: int) -> bool:
    # A bit of a hash: consecutive numbers must not simply alternate.
    return bool((number * 2654435761 >> 13) & 1)


def _none(random: Random, number: int) -> Values:
    return ()


def _joint(random: Random, number: int) -> Values:
    return (random.randint(1, 6),)


def _servo(random: Random, number: int) -> Values:
    return (random.randint(1, 6), random.choice((20, 21, 22, 23, 24)))


def _pin(random: Random, number: int) -> Values:
    return (random.choice((19, 22, 23, 33)),)


def _target(random: Random, number: int) -> Values:
    return ([number % 9000 / 100, number // 9000 / 100, 0.0, 0.0, 0.0, 0.0], 0)


QUERIES = (
    Kind("get_encoder", 10, _joint, lambda n: {"encoder": _word(n)}),
    Kind("get_angles", 6, _none, lambda n: {"angles": _angles(n)}),
    Kind("get_joint_min_angle", 5, _joint, lambda n: {"angle": _word(n) / 10}),
    Kind("get_servo_data", 5, _servo, lambda n: {"value": n * 97 % 251}),
    Kind("get_encoders", 2, _none, lambda n: {"encoders": [_word(n), n // 65000, 1, 2, 3, 4]}),
    Kind("is_power_on", 2, _none, lambda n: {"powered": _bit(n)}),
    Kind("is_servo_enable", 2, _joint, lambda n: {"enabled": _bit(n)}),
    Kind("get_digital_input", 2, _pin, lambda n: {"high": _bit(n)}),
    Kind("is_in_position", 2, _target, lambda n: {"reached": _bit(n)}),
)


def _colour(random: Random, number: int) -> Values:
    return (number >> 16 & 0xFF, number >> 8 & 0xFF, number & 0xFF)


def _all_joints(random: Random, number: int) -> Values:
    return ([number % 9000 / 100, number // 9000 / 100, 0.0, 0.0, 0.0, -2.58], 50)


def _one_joint(random: Random, number: int) -> Values:
    return (1 + number // 9000 % 6, number % 9000 / 100, 1 + number // 54000 % 100)


ONE_WAY = (
    Kind("set_color", 6, _colour),
    Kind("send_angles", 4, _all_joints),
    Kind("send_angle", 3, _one_joint),
    Kind("jog_increment", 3, _one_joint),
    Kind("stop", 1, _none),
)


# Requests shorter than send_angles. A full line may have taken half of a send_angles.
SHORT = ("stop", "set_color", "jog_increment")


def reply_values(command: Command, number: int, arguments: dict[str, Any]) -> dict[str, Any]:
    """Return the fields of reply number ``number``.

    If the edition has replies with and without the request's arguments, the two kinds alternate.
    """
    kind = next(kind for kind in QUERIES if kind.name == command.name)
    assert kind.reply is not None, "queries have replies"
    values = kind.reply(number)
    repeating = [v for v in command.reply if any(field.echo for field in v.fields)]
    plain = [v for v in command.reply if not any(field.echo for field in v.fields)]
    choices = [variants[0] for variants in (repeating, plain) if variants]
    variant = choices[number % len(choices)]
    return {f.name: values.get(f.name, arguments.get(f.name)) for f in variant.fields}


class Drawn(NamedTuple):
    """A call that was drawn: the client's method and its arguments."""

    name: str
    arguments: Values
    ack_within: float | None


def draw(random: Random, table: Table, number: int, one_way: float) -> Drawn:
    """Draw a call; ``one_way`` is the share of one-way requests."""
    kinds = ONE_WAY if random.random() < one_way else QUERIES
    [kind] = random.choices(kinds, [kind.weight for kind in kinds])
    acknowledged = kinds is ONE_WAY and table.command(kind.name).ack and random.random() < 0.3
    wait = random.choice((0.15, 0.3, 0.5)) if acknowledged else None
    return Drawn(kind.name, kind.arguments(random, number), wait)


def draw_flood(random: Random, number: int, name: str) -> Drawn:
    """Draw a one-way request that waits for no ack: command ``name``; empty: any command."""
    kinds = [kind for kind in ONE_WAY if name in (kind.name, "")]
    [kind] = random.choices(kinds, [kind.weight for kind in kinds])
    return Drawn(kind.name, kind.arguments(random, number), None)
