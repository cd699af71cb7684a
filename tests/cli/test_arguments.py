"""Parse the arguments of every command of every edition."""

from __future__ import annotations

import inspect
import shlex
from typing import Any

import pytest

from cobotwire import editions
from cobotwire.inspect.call_arguments import parse, request_values
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Command, Field
from strategies import TABLES, codec_of

CALLS = [(name, command) for name, table in TABLES.items() for command in table.commands]


@pytest.mark.parametrize(("edition", "command"), CALLS, ids=lambda x: getattr(x, "name", x))
def test_parsed_arguments_fit_the_client_method_and_the_codec(
    edition: str, command: Command
) -> None:
    client: Any = editions.load(edition).CLIENT
    method = inspect.signature(getattr(client, command.name))
    for number, variant in enumerate(command.request):
        given = [field for field in variant.fields if len(field.choices) != 1 or field.labels]
        words = [f"{field.name}={_word(field)}" for field in given]
        text = command.request_text.fields if command.request_text else ()
        values = parse(command, [*words, *(f"{name}=some {name}" for name in text)])
        method.bind(None, **values)
        codec_of(edition, "reference").encode(
            command.name, "request", request_values(command, values), variant=number
        )


def _word(field: Field) -> str:
    numbers = field.cases[0].numbers
    raw = [field.choices[0] if field.choices else number.minimum for number in numbers]
    values = (number.physical(value) for value, number in zip(raw, numbers))
    return ",".join(map(str, values))


@pytest.mark.parametrize(
    "words",
    [
        "-10 0 0 0 0 5 30",
        "[-10, 0, 0, 0, 0, 5] 30",
        "'-10, 0, 0, 0, 0, 5' 30",
        "speed=30 [-10,0,0,0,0,5]",
    ],
)
def test_list_is_accepted_with_commas_brackets_or_spaces(words: str) -> None:
    send_angles = TABLES["mycobot280"].command("send_angles")
    expected = {"angles": [-10, 0, 0, 0, 0, 5], "speed": 30}
    assert parse(send_angles, shlex.split(words)) == expected


def test_error_of_a_list_with_a_wrong_count_shows_how_to_write_the_call() -> None:
    send_coords = TABLES["mycobot280"].command("send_coords")
    with pytest.raises(UsageError, match="written as: send_coords 0,0,0,0,0,0 SPEED MODE"):
        parse(send_coords, ["1", "2", "3", "4", "5"])
    drag = TABLES["mycobot280"].command("set_encoders_drag")
    numbers = [*range(12)]
    assert parse(drag, [*map(str, numbers)]) == {"encoders": numbers[:6], "speeds": numbers[6:]}


def test_arguments_are_accepted_in_order_or_by_name() -> None:
    send_coords = TABLES["mycobot280"].command("send_coords")
    assert parse(send_coords, ["1,2,3,4,5,6", "speed=60"]) == {
        "coords": [1, 2, 3, 4, 5, 6],
        "speed": 60,
    }
    with pytest.raises(
        UsageError, match=r"send_coords\(\) is missing its argument speed; it takes"
    ):
        parse(send_coords, ["1,2,3,4,5,6"])
    with pytest.raises(UsageError, match=r"send_coords\(\) got its argument speed twice"):
        parse(send_coords, ["speed=60", "speed=70"])
