"""Parse the arguments of a command, or of a client's method, as people write them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from inspect import Parameter, signature
from itertools import accumulate, pairwise
from typing import Any, get_origin, get_type_hints

from cobotwire.protocol.arguments import choose
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Command, Field, Variant

_FLAGS = {"true": True, "yes": True, "on": True, "1": True}
_FLAGS |= {"false": False, "no": False, "off": False, "0": False}


def parse(command: Command, words: Sequence[str]) -> dict[str, Any]:
    """Return the arguments by name; words are in the method's order or written ``name=value``.

    A list is a word with commas, or as many words as it has numbers. The names choose the variant
    of the request. Arguments with a default may be left out. The text that follows a request is an
    argument like the fields.

    Raises:
        UsageError: an argument is missing, unknown, repeated, or not a value of its field.
    """
    text = command.request_text.fields if command.request_text else ()
    arguments = _by_name(command.name, _sizes(command), words)
    for name in text:
        if name not in arguments:
            raise _misfit(command.name, _sizes(command), name, f"is missing its argument {name}")
    try:
        fields = {field.name: field for field in _variant(command, arguments).fields}
    except UsageError:
        if problem := _miscounted(_sizes(command), words):
            raise _misfit(command.name, _sizes(command), "argument", problem) from None
        raise
    return {
        name: word if name in text else parse_value(fields[name], word)
        for name, word in arguments.items()
    }


def request_values(command: Command, arguments: Mapping[str, Any]) -> tuple[Any, ...]:
    """Return the values of the request's frame: the arguments, defaults and constants."""
    return tuple(
        ...
        if field.counts
        else arguments[field.name]
        if field.name in arguments
        else field.physical(field.default or (field.const or 0,))
        for field in _variant(command, arguments).fields
    )


def variant_of(command: Command, arguments: Mapping[str, Any]) -> int | None:
    """Return the index of the variant of a request that the arguments choose.

    None: the variant has a field of varying size, so the codec chooses by the size of the value.
    """
    variant = _variant(command, arguments)
    if any(field.sizes for field in variant.fields):
        return None
    return command.request.index(variant)


def _variant(command: Command, arguments: Mapping[str, Any]) -> Variant:
    text = command.request_text.fields if command.request_text else ()
    fields = [name for name in command.argument_names if name in arguments and name not in text]
    rows = tuple(variant.row for variant in command.request)
    try:
        chosen = choose(command.name, rows, fields)
    except TypeError as error:
        raise UsageError("arguments", message=str(error)) from None
    return command.request[chosen.first]


def parse_method(
    method: Callable[..., Any], sizes: Mapping[str, int], words: Sequence[str]
) -> dict[str, Any]:
    """Return the arguments of a method of a client; ``sizes`` has the sizes of its lists by name.

    Raises:
        UsageError: as :func:`parse`.
    """
    types = get_type_hints(method)
    _, *parameters = signature(method).parameters.values()
    takes = {
        each.name: 0 if each.kind is Parameter.KEYWORD_ONLY else sizes.get(each.name, 1)
        for each in parameters
    }
    name = method.__name__
    arguments = _by_name(name, takes, words)
    for each in parameters:
        if each.default is Parameter.empty and each.name not in arguments:
            problem = _miscounted(takes, words) or f"is missing its argument {each.name}"
            raise _misfit(name, takes, each.name, problem)
    return {each: _typed(each, types[each], word) for each, word in arguments.items()}


def _sizes(command: Command) -> dict[str, int]:
    """Return how many words each argument takes: one, or the size of a fixed-size list."""
    fields = [field for variant in command.request for field in variant.fields]
    lists = {f.name: len(f.cases[0].numbers) for f in fields if f.many and not (f.sizes or f.each)}
    return {name: lists.get(name, 1) for name in command.argument_names}


def _by_name(call: str, sizes: Mapping[str, int], words: Sequence[str]) -> dict[str, str]:
    """Return the words of each argument; one of size 0 must be written ``name=value``."""
    arguments: dict[str, str] = {}
    for word in words:
        name, equals, value = word.partition("=")
        if equals and name not in sizes:
            raise _misfit(call, sizes, "argument", f"has no argument for {word!r}")
        if equals and name in arguments:
            raise UsageError(name, word, message=f"{call}() got its argument {name} twice")
        if equals:
            arguments[name] = value
    free = [name for name, size in sizes.items() if size and name not in arguments]
    rest = [word for word in words if "=" not in word]
    if len(rest) > len(free):
        rest = _gather(rest, [sizes[name] for name in free])
    if len(rest) > len(free):
        problem = _miscounted(sizes, words) or f"has no argument for {rest[len(free)]!r}"
        raise _misfit(call, sizes, "argument", problem)
    return dict(zip(free, rest)) | arguments


def _gather(words: list[str], sizes: Sequence[int]) -> list[str]:
    """Join the numbers of each argument into one word, if they fill the first arguments."""
    ends = list(accumulate(sizes, initial=0))
    if len(words) not in ends:
        return words
    spans = pairwise(ends[: ends.index(len(words)) + 1])
    return [",".join(word.strip("[](), ") for word in words[a:b]) for a, b in spans]


def _miscounted(sizes: Mapping[str, int], words: Sequence[str]) -> str:
    """Return how many numbers a call takes, if their count is wrong; empty otherwise."""
    named = {word.partition("=")[0] for word in words if "=" in word}
    free = {name: size for name, size in sizes.items() if size and name not in named}
    plain = [word.strip("[](), ") for word in words if "=" not in word]
    if max(free.values(), default=1) < 2 or len(plain) < 2 or not all(map(_is_number, plain)):
        return ""
    parts = ", ".join(f"{size} for {name}" for name, size in free.items())
    return f"takes {sum(free.values())} numbers ({parts}), and {len(plain)} are given"


def _is_number(word: str) -> bool:
    try:
        _number("", word)
    except UsageError:
        return False
    return True


def _misfit(call: str, sizes: Mapping[str, int], name: str, problem: str) -> UsageError:
    text = f"{call}() {problem}; it takes {', '.join(sizes) or 'no arguments'}"
    if max(sizes.values(), default=1) > 1:
        shown = [name.upper() if n == 1 else ",".join("0" * n) for name, n in sizes.items() if n]
        text += f", written as: {call} {' '.join(shown)}"
    return UsageError(name, message=text)


def parse_value(field: Field, word: str) -> Any:
    """Parse a word as the value of a field: ``1,2`` is a row, ``1,2;3,4`` a list of rows.

    Raises:
        UsageError: the word is not a number, a flag or a member of the field's enum, or not the
            hex digits of bytes.
    """
    if field.kind == "text":
        return [part for part in word.split(",") if part] if field.each else word
    if field.kind == "bytes":
        return _bytes(field, word)
    if field.each:
        groups = [part.strip(" []()") for part in word.split(";")]
        return [_numbers(field.name, group) for group in groups if group]
    if field.many:
        return _numbers(field.name, word, [each.name for each in field.cases[0].numbers])
    if field.kind == "flag":
        return _flag(field.name, word)
    if word.upper() in field.labels:
        return field.choices[field.labels.index(word.upper())]
    if field.labels and not word.isdigit():
        members = (f"{label} ({choice})" for label, choice in zip(field.labels, field.choices))
        raise UsageError(field.name, word, ", ".join(members))
    number = field.cases[0].numbers[0]
    low, high = number.physical(number.minimum), number.physical(number.maximum)
    return _number(field.name, word, f"a number {low:g}..{high:g} {number.units}".rstrip())


def _typed(name: str, kind: Any, word: str) -> Any:
    if get_origin(kind) is Sequence:
        return _numbers(name, word)
    return _flag(name, word) if kind is bool else _number(name, word)


def _flag(name: str, word: str) -> bool:
    if word.lower() not in _FLAGS:
        raise UsageError(name, word, "on or off")
    return _FLAGS[word.lower()]


def _bytes(field: Field, word: str) -> bytes:
    try:
        return bytes.fromhex(word)
    except ValueError:
        raise UsageError(field.name, word, "pairs of hex digits") from None


def _numbers(name: str, word: str, parts_of: Sequence[str] = ()) -> list[int | float]:
    inner = word.strip("[]() ")
    parts = inner.split(",") if "," in inner else inner.split()
    names = [f"{name}.{each}" if each else name for each in parts_of[: len(parts)]]
    names += [name] * (len(parts) - len(names))
    return [_number(each, part.strip()) for each, part in zip(names, parts)]


def _number(name: str, word: str, allowed: str = "a number") -> int | float:
    for number in (lambda text: int(text, 0), float):
        try:
            return number(word)
        except ValueError:
            continue
    raise UsageError(name, word, allowed)
