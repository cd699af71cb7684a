"""The tools of an edition: one for each command, with schema, hints, arguments and result."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Literal, NamedTuple

from cobotwire.inspect.call_arguments import parse
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.json_values import as_json_value
from cobotwire.protocol.limits import Limits, limited
from cobotwire.protocol.refusals import refusals
from cobotwire.protocol.roles import row_index
from cobotwire.protocol.table import Command, Role, Table
from cobotwire.studio.forms import Form, forms

Choice = Literal["basic", "all"]
STOP = "stop"
# The tools that a model needs to move an arm and to see the outcome. Models choose worse among many
# tools, and some clients limit the number; most editions have a hundred commands.
BASIC: tuple[Role, ...] = (
    *("joints", "coordinates", "moving", "powered", "paused", "error", "version"),
    *("gripper", "light"),
)
# The client methods that return when the arm has arrived, and the role of the command of each.
WAITED: dict[str, Role] = {
    "move_angles": "joint targets",
    "move_coords": "coordinate targets",
}


class ToolSpec(NamedTuple):
    """A tool.

    Attributes:
        name: the name of the command, or of the client's method that waits for its motion.
        description: what it does, for a model.
        schema: the JSON schema of its arguments.
        command: what it sends.
        hints: MCP's annotations of a tool, by their names in MCP.
    """

    name: str
    description: str
    schema: dict[str, Any]
    command: Command
    hints: dict[str, bool]

    def arguments(self, values: Mapping[str, Any]) -> tuple[list[Any], dict[str, Any]]:
        """Return the arguments of the client's method.

        Raises:
            UsageError: an argument is missing, unknown, or not a value of its field.
        """
        words = [f"{name}={_word(name, value)}" for name, value in values.items()]
        parsed = parse(self.command, words)
        if self.name not in WAITED:
            return [], parsed
        # The methods take the row first and the rest in the order of the request's class; the keys
        # of a JSON object have no order.
        kind, row = self.command.request_type, _row(self.command)
        names: tuple[str, ...] = kind.__match_args__
        others = [parsed.get(each, vars(kind).get(each)) for each in names if each != row]
        return [parsed[row], *others], {}

    def result(self, value: Any) -> dict[str, Any]:
        """Return a result as a JSON object, with the unit of each number that has one."""
        if value is None:
            return {"result": "the arm has arrived" if self.name in WAITED else "sent"}
        numbers = [n for variant in self.command.reply for f in variant.fields for n in f.numbers]
        fields = [f for variant in self.command.reply for f in variant.fields if f.numbers]
        units = {n.name: n.units for n in numbers if n.name and n.units}
        units |= {f.name: f.numbers[0].units for f in fields if f.numbers[0].units and not f.many}
        return {"result": as_json_value(value)} | ({"units": units} if units else {})


def tools(
    table: Table, limits: Limits, allow_motion: bool, choice: Choice = "basic"
) -> dict[str, ToolSpec]:
    """Return the tools by name: ``stop`` first, then queries, and with permission the rest.

    Commands that ``limits`` refuse are left out; the others have the ranges of ``limits``.
    """
    shown = limited(table, limits)
    refused = refusals(table, limits)
    by_name = {form["name"]: form for form in forms(shown)}
    found = {}
    stop = shown.find_role("stop")
    if stop is not None:
        spec = _spec(STOP, stop, by_name[stop.name])
        found[STOP] = spec._replace(description="Stop the arm at once. It works at any time.")
    for name, command in _chosen(shown, choice):
        if command.name not in refused and (allow_motion or command.safety == "query"):
            found.setdefault(name, _spec(name, command, by_name[command.name]))
    return found


def _chosen(table: Table, choice: Choice) -> Iterator[tuple[str, Command]]:
    power = table.find_setter("powered", 1)
    for command in table.commands:
        basic = command.role in BASIC or command == power
        if not command.event and (basic or choice == "all"):
            yield command.name, command
    for name, role in WAITED.items():
        if (target := table.find_role(role)) is not None:
            yield name, target


def _spec(name: str, command: Command, form: Form) -> ToolSpec:
    arguments = {each["name"]: each for each in form["arguments"]}
    schema = {
        "type": "object",
        "properties": {each: _property(form) for each, form in arguments.items()},
        "required": [each for each, form in arguments.items() if not form["optional"]],
        "additionalProperties": False,
    }
    about = f"{command.title}. {command.doc}"
    if name in WAITED:
        about += " It returns when the arm has arrived, or reports why it has not."
    if command.safety == "persistent write":
        about += " Its effect persists without power: ask the user before you use it."
    query = command.safety == "query"
    harmless = query or command.safety == "setting" or command.is_stop
    hints = {
        "readOnlyHint": query,
        "destructiveHint": not harmless,
        "idempotentHint": harmless,
        "openWorldHint": False,
    }
    return ToolSpec(name, about, schema, command, hints)


def _property(form: Form) -> dict[str, Any]:
    """Return the JSON schema of an argument of a form."""
    about = [form["doc"]]
    found: dict[str, Any]
    if form["kind"] in ("bytes", "text"):
        found = {"type": "string"}
        if form["kind"] == "bytes":
            about.append("Pairs of hex digits.")
    elif form["kind"] == "flag":
        found = {"type": "boolean"}
    elif form["choices"] and not form["many"]:
        labels = [choice["label"].rpartition(" (")[0] for choice in form["choices"]]
        found = {"enum": labels if all(labels) else [int(c["value"]) for c in form["choices"]]}
    else:
        cases = form.get("cases") or [{"elements": form["elements"]}]
        elements = [each for case in cases for each in case["elements"]]
        about += dict.fromkeys(map(_range, elements))
        found = _numbers(elements)
        if form["many"]:
            count = {} if form.get("list") else {n: len(elements) for n in ("minItems", "maxItems")}
            found = {"type": "array", "items": found} | count
    return found | {"description": " ".join(filter(None, about))}


def _numbers(elements: list[Form]) -> dict[str, Any]:
    """Return one schema for several numbers; its range covers the range of each."""
    whole = all(each["step"] == 1 for each in elements)
    found: dict[str, Any] = {"type": "integer" if whole and elements else "number"}
    ends = [each[end] for end in ("low", "high") for each in elements]
    if ends and None not in ends:
        found |= {"minimum": min(ends), "maximum": max(ends)}
    return found


def _range(element: Form) -> str:
    if element["low"] is None:
        return f"{element['name']} in {element['unit']}." if element["unit"] else ""
    text = f"{element['name']} {element['low']:g}..{element['high']:g} {element['unit']}"
    return f"{text.strip()}."


def _row(command: Command) -> str:
    return command.request[0].fields[row_index(command.request[0])].name


def _word(name: str, value: Any) -> str:
    """Return a JSON value as a person writes it on the command line."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, int | float | str):
        return str(value)
    if isinstance(value, list):
        nested = any(isinstance(each, list) for each in value)
        return (";" if nested else ",").join(_word(name, each) for each in value)
    raise UsageError(name, value, "a number, a text, true, false, or a list of them")
