"""Generate the harness's part for one edition: typed calls and the header's value helpers."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen import lower
from cobotwire_codegen.model import Edition, Quantity, Type, Value
from cobotwire_codegen.targets.c import names
from cobotwire_codegen.targets.c.messages import Member, Message, messages


def glue(edition: Edition) -> str:
    """Return ``physical.h``, the part that uses the edition's structs by name."""
    p, found = edition.name, messages(edition)
    most = max(message.count for message in found)
    address = "address, " if edition.frame.addresses else ""
    return "\n".join(
        [
            f'#define PREFIX {p}_\n#include "{p}.h"',
            f"#define NUMBERS {max(most, 1)}\n#define MESSAGES {len(found)}u",
            "static const size_t COUNTS[] = {" + ", ".join(str(m.count) for m in found) + "};",
            f"static void to_physical(unsigned message, const {p}_any_t *any, double *out)",
            *_switch(found, lambda message: _to_physical(p, message), "(void)any; (void)out;"),
            f"static void from_physical(unsigned message, const double *in, {p}_any_t *any)",
            *_switch(found, lambda message: _from_physical(p, message), "(void)any; (void)in;"),
            "static unsigned typed_encode(unsigned message, uint8_t address,",
            f"const {p}_any_t *any, uint8_t *out, size_t room, size_t *size, {p}_fault_t *fault)",
            *_switch(
                found,
                lambda message: [
                    f"(void)address; (void)any; return {p}_encode_{message.symbol}"
                    f"({address}{_struct(message)}out, room, size, fault);"
                ],
                "return 99;",
            ),
            "static unsigned typed_decode(unsigned message, const uint8_t *data, size_t size,",
            f"{p}_any_t *any, {p}_fault_t *fault)",
            *_switch(
                found,
                lambda message: [
                    f"(void)any; return {p}_decode_{message.symbol}"
                    f"(data, size, {_struct(message)}fault);"
                ],
                "return 99;",
            ),
            "",
        ]
    )


def _struct(message: Message) -> str:
    return f"&any->{message.symbol}, " if message.count else ""


def _switch(found, lines, end: str = "") -> Iterator[str]:  # type: ignore[no-untyped-def]
    yield "{ switch (message) {"
    for index, message in enumerate(found):
        yield f"case {index}:"
        yield from lines(message)
        yield "break;"
    yield f"default: break; }} {end} }}"


def _to_physical(p: str, message: Message) -> Iterator[str]:
    for member, when, place, index, type in _elements(message):
        where = f"any->{message.symbol}.{place}"
        helper = _helper(p, type, "to")
        value = f"{helper}({where})" if helper else f"(double){where}"
        yield f"{_condition(message, member, when)}out[{index}] = {value};"


def _from_physical(p: str, message: Message) -> Iterator[str]:
    ordered = sorted(_elements(message), key=lambda element: bool(element[0].field.selector))
    for member, when, place, index, type in ordered:
        where = f"any->{message.symbol}.{place}"
        helper = _helper(p, type, "from")
        # No field allows the largest number, so it marks a value that has no raw value.
        scaled = f"if (!{helper}(in[{index}], &{where})) {where} = INT32_MAX;"
        plain = f"{where} = ({p}_raw_t)in[{index}];"
        yield f"{_condition(message, member, when)}{{ {scaled if helper else plain} }}"


def _condition(message: Message, member: Member, when: tuple[int, ...]) -> str:
    if not when:
        return ""
    selector = next(other for other in message.members if other.field.name == member.field.selector)
    own = f"any->{message.symbol}.{names.member(selector.field.name)}"
    return "if (" + " || ".join(f"{own} == {value}" for value in when) + ") "


def _elements(message: Message) -> Iterator[tuple[Member, tuple[int, ...], str, int, Type]]:
    """Yield each number of a struct in each of its cases: member, when, name, place, type."""
    for member in message.fields:
        own = names.member(member.field.name)
        for when, type in lower.cases(member.field):
            if isinstance(type, Value):
                for index, (_, item) in enumerate(type.items):
                    yield member, when, f"{own}[{index}]", member.index + index, item
            else:
                yield member, when, own, member.index, type


def _helper(p: str, type: Type, way: str) -> str:
    """Return the header's function for a scaled quantity; empty if the scale is one."""
    if not isinstance(type, Quantity) or type.scale == 1:
        return ""
    return f"{p}_{type.name}_{way}_{type.unit or 'value'}"
