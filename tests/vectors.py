"""Load the spec's model and its vectors through the generator."""

from __future__ import annotations

import os
import pickle
import sys
from collections.abc import Container, Iterator, Sequence
from fractions import Fraction
from functools import lru_cache
from hashlib import sha256
from importlib import import_module
from itertools import product
from pathlib import Path
from typing import Any, TypeVar

from cobotwire_codegen import project
from cobotwire_codegen.model import Edition, Enum, Octets, Vector
from cobotwire_codegen.wire import encode_variant

ROOT = Path(__file__).parent.parent
A = TypeVar("A")
B = TypeVar("B")


@lru_cache(maxsize=1)
def editions() -> dict[str, Edition]:
    """Return the checked models of all editions by name.

    The first process keeps them for the others: to load them takes seconds in each.
    """
    folder = ROOT / "target" / "tests"
    folder.mkdir(parents=True, exist_ok=True)
    kept = folder / f"editions-{_inputs()}.pickle"
    with (folder / "lock").open("w") as lock:
        if os.name == "posix":
            fcntl = import_module("fcntl")
            fcntl.flock(lock, fcntl.LOCK_EX)
        if not kept.exists():
            for old in folder.glob("editions-*.pickle"):
                old.unlink()
            found = {edition.name: edition for edition in project.editions(ROOT)}
            # Never half a file, even if the process is killed.
            (new := folder / "new").write_bytes(pickle.dumps(found))
            new.replace(kept)
        loaded: dict[str, Edition] = pickle.loads(kept.read_bytes())
        return loaded


def _inputs() -> str:
    """Return a number that changes with the spec, the generator and the version of Python."""
    found = [sys.version]
    for folder in ("spec", "codegen/src"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.is_file() and path.suffix != ".pyc":
                found.append(f"{path} {path.stat().st_size} {path.stat().st_mtime_ns}")
    return sha256("\n".join(found).encode()).hexdigest()[:16]


def edition(name: str = "mycobot") -> Edition:
    """Return the checked model of an edition."""
    return editions()[name]


# These editions have many tests of their own; most further ones are stated as differences from
# them.
ONE_BY_ONE = ("mycobot", "mycobot280")


def further() -> list[str]:
    """Return the names of the other editions."""
    return [name for name in editions() if name not in ONE_BY_ONE]


# The frames of each family: with a footer, with an address, with a check value, with a CRC.
SAMPLE = (*ONE_BY_ONE, "mybuddy", "mercury_a1", "mercury_b1", "pro450")


def sampled(sample: Container[str] = SAMPLE) -> list[str]:
    """Return the editions that represent all in tests of a law that every edition has.

    ``make every-edition`` tests all of them.
    """
    every = sorted(path.stem for path in project.edition_files(ROOT))
    return every if "EVERY_EDITION" in os.environ else [name for name in every if name in sample]


# The editions with pages on the site that tests build: one of each kind of frame, and the largest.
ON_SITE = sampled(("mycobot", "mycobot280", "mercury_a1", "mercury_b1", "pro450"))
NOT_ON_SITE = {path.stem for path in project.edition_files(ROOT)} - {*ON_SITE}


def sampled_pairs(first: Sequence[A], second: Sequence[B]) -> list[tuple[A, B]]:
    """Return pairs in which each item of both occurs; ``make every-edition`` tests all pairs."""
    if "EVERY_EDITION" in os.environ:
        return list(product(first, second))
    longest = range(max(len(first), len(second)))
    return [(first[i % len(first)], second[i % len(second)]) for i in longest]


def limits(name: str, vector: Vector) -> Iterator[tuple[dict[str, Any], bool]]:
    """Yield a vector's values with another value for one field, and whether that is legal."""
    given = fields(name, vector)
    for stated, legal in ((vector.accepted, True), (vector.refused, False)):
        for key, values in stated:
            for value in values:
                found = plain(edition(name), vector, key, value)
                yield {**given, key: tuple(found) if isinstance(found, list) else found}, legal


def fields(name: str, vector: Vector) -> dict[str, Any]:
    """Return a vector's values by name, as the codecs return them."""
    # Several tests of both codecs use each vector; to hash a vector takes as long as this.
    key = name, id(vector)
    if key not in _FIELDS:
        _FIELDS[key] = vector, _fields(name, vector)
    return dict(_FIELDS[key][1])


def _fields(name: str, vector: Vector) -> dict[str, Any]:
    found = {key: plain(edition(name), vector, key, value) for key, value in vector.values}
    command = next(each for each in edition(name).commands if each.name == vector.command)
    octets = {field.name for field in command.fields if isinstance(field.type, Octets)}
    return {key: _decoded(v, key in octets) for key, v in found.items()}


# Keep the vector too, so that no other object gets its id.
_FIELDS: dict[tuple[str, int], tuple[Vector, dict[str, Any]]] = {}


def plain(edition: Edition, vector: Vector, name: str, value: object) -> Any:
    """Return a vector's value as the codecs expect it: members as integers, fractions as floats."""
    if isinstance(value, tuple):
        return [plain(edition, vector, name, item) for item in value]
    if isinstance(value, Fraction):
        return float(value)
    # Only a text or a truth value can stand for the number of a member.
    if vector.frame is None or type(value) is int:
        return value
    command = edition.by_name[vector.command]
    variant, _ = encode_variant(command, vector.direction, dict(vector.values))
    field = next(field for field in variant if field.name == name)
    if not isinstance(field.type, Enum):
        return value
    if field.const is not None:
        return field.const
    return next(member.value for member in field.type.members if member.name == value)


def _decoded(value: Any, octets: bool) -> Any:
    """Return a value as the codecs do: rows as tuples, bytes instead of hex digits."""
    if octets and isinstance(value, str):
        return bytes.fromhex(value)
    return tuple(value) if isinstance(value, list) else value
