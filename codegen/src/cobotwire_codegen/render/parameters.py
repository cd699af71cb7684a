"""Arguments and results of a method: the fields of all forms of a message, by name."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire_codegen import lower
from cobotwire_codegen.model import Command, Enum, Field, Flag, Form, Quantity, Type, Value
from cobotwire_codegen.render.words import allowed


@dataclass(frozen=True, slots=True)
class Parameter:
    """An argument or a result; ``fields`` is how it stands in each form that has it."""

    name: str
    fields: tuple[Field, ...]
    optional: bool

    @property
    def types(self) -> tuple[Type, ...]:
        """Every type that it can have, each once."""
        found = (type for field in self.fields for _, type in lower.cases(field))
        return tuple(dict.fromkeys(found))

    @property
    def doc(self) -> str:
        """What it is."""
        return self.fields[0].doc

    @property
    def allowed(self) -> str:
        """What it may be, in words."""
        return " or ".join(dict.fromkeys(allowed(field) for field in self.fields))

    @property
    def radians(self) -> bool:
        """Whether the API speaks radians where the wire carries degrees."""
        return any(_radians(type) for type in self.types)


def parameters(command: Command) -> list[Parameter]:
    """The arguments of a command: first those that every form of the request has."""
    found = _by_name(command.requests)
    given = [p for p in found if all(field.const is None for field in p.fields)]
    return sorted(given, key=lambda parameter: parameter.optional)


def results(command: Command) -> list[Parameter]:
    """What every form of the reply tells and the caller does not know already."""
    if command.ack:
        return []
    found = _by_name(command.replies)
    return [p for p in found if not p.optional and not any(field.echo for field in p.fields)]


def _by_name(forms: tuple[Form, ...]) -> list[Parameter]:
    longest_first = sorted(forms, key=len, reverse=True)
    names = dict.fromkeys(field.name for form in longest_first for field in form)
    found = []
    for name in names:
        fields = tuple(field for form in forms for field in form if field.name == name)
        found.append(Parameter(name, fields, len(fields) < len(forms)))
    return found


def _radians(type: Type) -> bool:
    if isinstance(type, Value):
        return any(item.radians for _, item in type.items)
    return isinstance(type, Quantity) and type.radians


def argument_type(parameter: Parameter) -> str:
    """The annotation of an argument."""
    words = dict.fromkeys(_argument(type) for type in parameter.types)
    if set(words) == {"int", "float"}:
        words = {"float": None}
    return " | ".join([*words, *(["None"] if parameter.optional else [])])


def _argument(type: Type) -> str:
    if isinstance(type, Value):
        return f"Sequence[{'float' if scaled(type) else 'int'}]"
    if isinstance(type, Enum):
        return f"{type.class_name} | int"
    return _scalar(type)


def scaled(type: Value) -> bool:
    """Whether a value has a part that is no whole number."""
    return any(item.scale != 1 for _, item in type.items)


def _scalar(type: Type) -> str:
    if isinstance(type, Flag):
        return "bool"
    return "int" if isinstance(type, Quantity) and type.scale == 1 else "float"


def result_type(parameter: Parameter) -> str:
    """The annotation of a result."""
    first = parameter.types[0]
    same = len(parameter.types) == 1
    if isinstance(first, Value):
        if same:
            return first.class_name
        every = [type for type in parameter.types if isinstance(type, Value)]
        return f"tuple[{'float' if any(map(scaled, every)) else 'int'}, ...]"
    if isinstance(first, Enum) and same:
        return first.class_name
    words = {_scalar(type) if not isinstance(type, Enum) else "int" for type in parameter.types}
    return words.pop() if len(words) == 1 else "float"


def result_expression(parameter: Parameter) -> str:
    """The expression that makes one result out of the reply."""
    value = f'reply["{parameter.name}"]'
    if parameter.radians:
        value = f"to_radians({value})"
    kind = result_type(parameter)
    if not isinstance(parameter.types[0], Value):
        return f"{kind}({value})"
    return f"tuple({value})" if kind.startswith("tuple") else f"{kind}(*{value})"


def argument_expression(parameter: Parameter) -> str:
    """The expression that gives an argument to the codec."""
    return f"to_degrees({parameter.name})" if parameter.radians else parameter.name
