"""Writes names, numbers and comments in C."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence

# The keywords of C++ are included, since a C++ program may include the header.
_WORDS = """
    alignas alignof and and_eq asm auto bitand bitor bool break case catch char class compl const
    const_cast constexpr continue decltype default delete do double dynamic_cast else enum explicit
    export extern false float for friend goto if inline int long mutable namespace new noexcept not
    not_eq nullptr operator or or_eq private protected public register reinterpret_cast restrict
    return short signed sizeof static static_assert static_cast struct switch template this
    thread_local throw true try typedef typeid typename typeof union unsigned using virtual void
    volatile wchar_t while xor xor_eq
"""
KEYWORDS = frozenset(_WORDS.split())
WIDTH = 100


def member(name: str) -> str:
    """Return the name of a field's struct member."""
    return f"{name}_" if name in KEYWORDS else name


def counter(name: str, taken: set[str]) -> str:
    """Return the name of the member that counts the elements of a list, and add it to ``taken``."""
    found = f"{name}_count"
    while found in taken:
        found += "_"
    taken.add(found)
    return found


def integer(value: int) -> str:
    """Return an integer as a constant of a type that is wide enough."""
    # The lowest number of a type has no constant: its minus sign is an operator.
    return f"({value + 1} - 1)" if value <= -(2**31) else str(value)


def string(text: str) -> str:
    """Return text as a string constant; bytes that are not printable ASCII are escaped in octal."""
    plain = {'"': '\\"', "\\": "\\\\", "?": "\\?"}
    return '"' + "".join(_character(byte, plain) for byte in text.encode()) + '"'


def _character(byte: int, plain: dict[str, str]) -> str:
    letter = chr(byte)
    return plain.get(letter, letter) if 0x20 <= byte < 0x7F else f"\\{byte:03o}"


def comment(text: str, indent: int = 0) -> str:
    """Return a comment, on several lines if needed."""
    margin = " " * indent
    safe = " ".join(text.split()).replace("*/", "* /").replace("/*", "/ *")
    lines = textwrap.wrap(safe, WIDTH - indent - 6, break_on_hyphens=False) or [""]
    return f"{margin}/* " + f"\n{margin} * ".join(lines) + " */"


def rows(items: Iterable[str]) -> str:
    """Return the elements of an array, as many on a line as fit; C needs at least one element."""
    lines = [""]
    for item in items:
        if len(lines[-1]) + len(item) + 6 > WIDTH and lines[-1]:
            lines.append("")
        lines[-1] += f"{item}, "
    return "\n".join(f"    {line.rstrip()}" for line in lines if line) or "    0"


def bits(numbers: Sequence[int]) -> list[str]:
    """Return a set of byte values as a mask of 256 bits, in 32 bytes."""
    mask = sum(1 << number for number in set(numbers))
    return [f"0x{byte:02X}" for byte in mask.to_bytes(32, "little")]
