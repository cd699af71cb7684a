"""Words to values: every command of every edition can be called with what its method takes."""

from __future__ import annotations

import inspect
from typing import Any

import pytest

from cobotwire import editions
from cobotwire.cli.arguments import framed, parse
from cobotwire.errors import UsageError
from cobotwire.table import Command, Field
from strategies import TABLES, codec_of

CALLS = [(name, command) for name, table in TABLES.items() for command in table.commands]


@pytest.mark.parametrize(("edition", "command"), CALLS, ids=lambda x: getattr(x, "name", x))
def test_each_forms_words_are_the_methods_arguments(edition: str, command: Command) -> None:
    client: Any = editions.load(edition).CLIENT
    method = inspect.signature(getattr(client, command.name))
    for number, form in enumerate(command.request):
        given = [field for field in form.fields if len(field.choices) != 1 or field.labels]
        words = [f"{field.name}={_word(field)}" for field in given]
        text = command.request_text.fields if command.request_text else ()
        values = parse(command, [*words, *(f"{name}=some {name}" for name in text)])
        method.bind(None, **values)
        codec_of(edition, "reference").encode(
            command.name, "request", framed(command, values), form=number
        )


def _word(field: Field) -> str:
    numbers = field.cases[0].numbers
    steps = [field.choices[0] if field.choices else number.minimum for number in numbers]
    values = (step * n.multiply / n.divide if n.scaled else step for step, n in zip(steps, numbers))
    return ",".join(map(str, values))


def test_words_in_order_and_what_may_be_left_out() -> None:
    send_coords = TABLES["mycobot280"].command("send_coords")
    assert parse(send_coords, ["1,2,3,4,5,6", "speed=60"]) == {
        "coords": [1, 2, 3, 4, 5, 6],
        "speed": 60,
    }
    with pytest.raises(UsageError, match="speed is None"):
        parse(send_coords, ["1,2,3,4,5,6"])
    with pytest.raises(UsageError, match="each once"):
        parse(send_coords, ["speed=60", "speed=70"])
