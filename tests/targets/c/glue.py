"""Generate the harness's part for one edition: typed calls and the numbers of each struct.

A message is a row of numbers: the numbers of each member in wire order. The elements of a list
follow their count. Constants, and fields that count elements, are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire_codegen import lower
from cobotwire_codegen.model import Bits, Chars, Edition, Listed, Octets, Quantity, Type, Value
from cobotwire_codegen.targets.c import names
from cobotwire_codegen.targets.c.messages import Member, Message, messages
from cobotwire_codegen.targets.c.storage import Leaf

Lines = Callable[[Message], Iterator[str]]


def glue(edition: Edition) -> str:
    """Return ``physical.h``, the part that uses the edition's structs by name."""
    p, found = edition.name, messages(edition)
    most = max(message.count + len(message.members) for message in found)
    return "\n".join(
        [
            f'#define PREFIX {p}_\n#include "{p}.h"',
            f"#define NUMBERS {max(most, 1)}\n#define MESSAGES {len(found)}u",
            f"static size_t to_numbers(unsigned message, const {p}_any_t *any,",
            "int64_t *raw, double *out)",
            "{ size_t k = 0, e, n; (void)any; (void)raw; (void)out; (void)e; (void)n;",
            *_switch(found, lambda message: _to_numbers(p, message)),
            "return k; }",
            "static void from_numbers(unsigned message, bool from_values,",
            f"const int64_t *raw, const double *in, {p}_any_t *any)",
            "{ size_t k = 0, e, n; (void)any; (void)raw; (void)in; (void)from_values;",
            "(void)k; (void)e; (void)n;",
            *_switch(found, lambda message: _from_numbers(p, message)),
            "}",
            "static unsigned typed_encode(unsigned message, uint8_t address,",
            f"const {p}_any_t *any, uint8_t *out, size_t room, size_t *size, {p}_fault_t *fault)",
            "{",
            *_switch(found, lambda message: iter([_encode(edition, message)])),
            "return 99; }",
            "static unsigned typed_decode(unsigned message, const uint8_t *data, size_t size,",
            f"{p}_any_t *any, {p}_fault_t *fault)",
            "{",
            *_switch(found, lambda message: iter([_decode(p, message)])),
            "return 99; }",
            "",
        ]
    )


def _encode(edition: Edition, message: Message) -> str:
    address = "address, " if edition.frame.address_values else ""
    call = f"{edition.name}_encode_{message.symbol}"
    arguments = f"{address}{_struct(message)}out, room, size, fault"
    return f"(void)address; (void)any; return {call}({arguments});"


def _decode(p: str, message: Message) -> str:
    return f"(void)any; return {p}_decode_{message.symbol}(data, size, {_struct(message)}fault);"


def _struct(message: Message) -> str:
    return f"&any->{message.symbol}, " if message.count else ""


def _switch(found: list[Message], lines: Lines) -> Iterator[str]:
    yield "switch (message) {"
    for index, message in enumerate(found):
        yield f"case {index}:"
        yield from lines(message)
        yield "break;"
    yield "default: break; }"


def _to_numbers(p: str, message: Message) -> Iterator[str]:
    for member in message.fields:
        yield from _count(message, member, "raw[k] = (int64_t)n; out[k] = (double)n; k++;")
        for when, type, leaves in _cases(member):
            inner = ""
            for index, (leaf, part) in enumerate(zip(leaves, _parts(type))):
                where, at = _where(message, member, leaf), f"k + e * {len(leaves)} + {index}"
                helper = _helper(p, part, "to")
                kind = {"FLOAT": "32", "DOUBLE": "64"}.get(leaf.kind)
                raw = f"rank{kind}(&{where})" if kind else where
                value = f"{helper}({where})" if helper else f"(double){where}"
                inner += f"raw[{at}] = {raw}; out[{at}] = {value}; "
            yield _loop(message, member, when, inner)
        yield _advance(member)


def _from_numbers(p: str, message: Message) -> Iterator[str]:
    # A selector's value decides how the other fields are stored.
    for member in message.fields:
        yield from _count(
            message, member, f"n = (size_t)raw[k]; {_counter(message, member)} = (uint16_t)n; k++;"
        )
        if not member.field.selector:
            yield from _set(p, message, member)
        yield _advance(member)
    yield "k = 0;"
    for member in message.fields:
        yield from _count(message, member, "k++;")
        if member.field.selector:
            yield from _set(p, message, member)
        yield _advance(member)


def _set(p: str, message: Message, member: Member) -> Iterator[str]:
    for when, type, leaves in _cases(member):
        inner = ""
        for index, (leaf, part) in enumerate(zip(leaves, _parts(type))):
            where, at = _where(message, member, leaf), f"k + e * {len(leaves)} + {index}"
            helper = _helper(p, part, "from")
            if leaf.kind in ("FLOAT", "DOUBLE"):
                kind, bits = ("float", 32) if leaf.kind == "FLOAT" else ("double", 64)
                taken = f"{where} = ({kind})in[{at}]; else unrank{bits}(&{where}, raw[{at}]);"
                inner += f"if (from_values) {taken} "
                continue
            # No field allows the largest number, so it marks a value that has no raw value.
            scaled = f"if (!{helper}(in[{at}], &{where})) {where} = INT32_MAX;"
            type_of = "uint8_t" if leaf.kind == "BYTE" else f"{p}_raw_t"
            plain = f"{where} = ({type_of})in[{at}];"
            taken = f"{{ {scaled if helper else plain} }} else {where} = ({type_of})raw[{at}];"
            inner += f"if (from_values) {taken} "
        yield _loop(message, member, when, inner)


def _count(message: Message, member: Member, lines: str) -> Iterator[str]:
    yield f"n = {_counter(message, member) if member.counter else member.storage.least};"
    if member.counter:
        yield lines


def _counter(message: Message, member: Member) -> str:
    return f"any->{message.symbol}.{member.counter}"


def _advance(member: Member) -> str:
    stored = member.storage
    return f"k += n * {stored.each * max(map(len, stored.cases))};"


def _loop(message: Message, member: Member, when: tuple[int, ...], inner: str) -> str:
    stored = member.storage
    loop = (
        f"for (e = 0; e < n * {stored.each} && e < {stored.most * stored.each}; e++) {{ {inner}}}"
    )
    if not when:
        return loop
    selector = next(other for other in message.members if other.field.name == member.field.selector)
    own = f"any->{message.symbol}.{names.member(selector.field.name)}"
    return "if (" + " || ".join(f"{own} == {value}" for value in when) + f") {{ {loop} }}"


def _where(message: Message, member: Member, leaf: Leaf) -> str:
    own = f"any->{message.symbol}.{member.name}"
    if leaf.kind == "BYTE":
        return f"((uint8_t *){own})[e]"
    return f"{own}[e]{leaf.access}" if isinstance(member.field.type, Listed) else own + leaf.access


def _cases(member: Member) -> Iterator[tuple[tuple[int, ...], Type, tuple[Leaf, ...]]]:
    for (when, type), leaves in zip(lower.cases(member.field), member.storage.cases):
        yield when, type, leaves


def _parts(type: Type) -> list[Type | None]:
    inner = type.of if isinstance(type, Listed) else type
    if isinstance(inner, Octets | Chars):
        return [None]
    return [part for _, part in inner.items] if isinstance(inner, Value | Bits) else [inner]


def _helper(p: str, type: Type | None, way: str) -> str:
    """Return the header's function for a scaled quantity; empty if the scale is one."""
    if not isinstance(type, Quantity) or type.scale == 1:
        return ""
    return f"{p}_{type.name}_{way}_{type.unit or 'value'}"
