"""What the Python client's templates need: annotations, conversions, signatures."""

from __future__ import annotations

import textwrap

from cobotwire_codegen import lower
from cobotwire_codegen.model import (
    Command,
    Edition,
    Enum,
    Family,
    Field,
    Flag,
    Quantity,
    Type,
    Value,
)

INDENT = 8
WIDTH = 100


def annotation(field: Field) -> str:
    """The type of an argument."""
    words = dict.fromkeys(_argument(type) for _, type in lower.cases(field))
    if len(words) > 1 and set(words) == {"int", "float"}:
        return "float"
    return " | ".join(words)


def _argument(type: Type) -> str:
    if isinstance(type, Value):
        scaled = any(item.scale != 1 for _, item in type.items)
        return f"Sequence[{'float' if scaled else 'int'}]"
    if isinstance(type, Enum):
        return f"{type.class_name} | int"
    return _scalar(type)


def _scalar(type: Type) -> str:
    if isinstance(type, Flag):
        return "bool"
    return "int" if isinstance(type, Quantity) and type.scale == 1 else "float"


def results(command: Command) -> tuple[Field, ...]:
    """The parts of a reply that the caller does not know already."""
    return tuple(field for field in command.reply if not field.echo)


def result_class(command: Command) -> str:
    """The named tuple of a reply with several results."""
    return "".join(word.capitalize() for word in command.name.split("_")) + "Reply"


def returns(command: Command) -> str:
    """The type of the result."""
    fields = results(command)
    if command.text is not None:
        return command.text.class_name
    if not fields:
        return "None"
    return result(fields[0]) if len(fields) == 1 else result_class(command)


def result(field: Field) -> str:
    """The type of one result."""
    if isinstance(field.type, Value):
        return "tuple[float, ...]" if field.by else field.type.class_name
    if field.by:
        return "float"
    return field.type.class_name if isinstance(field.type, Enum) else _scalar(field.type)


def convert(field: Field) -> str:
    """The expression that makes one result out of the reply."""
    value = f'reply["{field.name}"]'
    if isinstance(field.type, Value):
        return f"tuple({value})" if field.by else f"{field.type.class_name}(*{value})"
    return f"{result(field)}({value})"


def answer(command: Command) -> str:
    """The expression that makes the whole result out of the reply."""
    if command.text is not None:
        names = ", ".join(f'reply["{name}"]' for name, _ in command.text.fields)
        return f"{command.text.class_name}({names})"
    fields = results(command)
    if len(fields) == 1:
        return convert(fields[0])
    return f"{result_class(command)}({', '.join(convert(field) for field in fields)})"


def signature(command: Command) -> str:
    """The method's head, laid out as ruff lays it out."""
    parts = ["self", *(f"{field.name}: {annotation(field)}" for field in command.request)]
    tail = f") -> {returns(command)}:"
    flat = f"def {command.name}({', '.join(parts)}{tail}"
    if len(flat) + 4 <= WIDTH:
        return flat
    joined = ", ".join(parts)
    if len(joined) + INDENT <= WIDTH:
        return f"def {command.name}(\n        {joined}\n    {tail}"
    lines = "".join(f"        {part},\n" for part in parts)
    return f"def {command.name}(\n{lines}    {tail}"


def arguments(command: Command) -> str:
    """The tuple of values for the codec."""
    names = [field.name for field in command.request]
    return f"({names[0]},)" if len(names) == 1 else f"({', '.join(names)})"


def docstring(text: str, indent: int) -> str:
    """A docstring of one paragraph, on one line if it fits."""
    flat = f'{" " * indent}"""{text}"""'
    if len(flat) <= WIDTH:
        return flat
    opened = wrapped(f'"""{text}', indent)
    return f'{opened}\n{" " * indent}"""'


def wrapped(text: str, indent: int, hanging: int = 0) -> str:
    """A paragraph, wrapped; further lines stand ``hanging`` deeper."""
    return textwrap.fill(
        text,
        WIDTH,
        initial_indent=" " * indent,
        subsequent_indent=" " * (indent + hanging),
        break_long_words=False,
        break_on_hyphens=False,
    )


def imports(family: Family) -> tuple[list[str], list[str], bool]:
    """What a family's methods need: enums, value classes, and whether Sequence."""
    enums: set[str] = set()
    values: set[str] = set()
    sequence = False
    for command in family.commands:
        for field in command.request:
            for _, type in lower.cases(field):
                sequence = sequence or isinstance(type, Value)
                if isinstance(type, Enum):
                    enums.add(type.class_name)
        for field in results(command):
            if isinstance(field.type, Enum):
                enums.add(field.type.class_name)
            if isinstance(field.type, Value) and not field.by and len(results(command)) == 1:
                values.add(field.type.class_name)
        if command.text is not None or len(results(command)) > 1:
            values.add(returns(command))
    return sorted(enums), sorted(values), sequence


def value_classes(edition: Edition) -> list[str]:
    """Every named tuple of an edition."""
    names = {type.class_name for type in edition.types if isinstance(type, Value)}
    for command in edition.commands:
        if command.text is not None or len(results(command)) > 1:
            names.add(returns(command))
    return sorted(names)


def replies_need_enums(edition: Edition) -> list[str]:
    """The enums that stand in replies with several results."""
    fields = [f for c in edition.commands if len(results(c)) > 1 for f in results(c)]
    return sorted({f.type.class_name for f in fields if isinstance(f.type, Enum)})


def capitalize_first(text: str) -> str:
    """A sentence's first letter, without touching the others."""
    return text[:1].upper() + text[1:]


def oneline(text: str) -> str:
    """A signature on one line."""
    flat = " ".join(text.split()).replace("( ", "(").replace(", )", ")").replace(" )", ")")
    return (
        flat.removeprefix("def ").removesuffix(":").replace("(self, ", "(").replace("(self)", "()")
    )
