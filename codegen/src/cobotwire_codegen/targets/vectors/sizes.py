"""Lists the sizes that a variant of a message can have, each as a variant of fixed size."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

from cobotwire_codegen.model import Chars, Field, Listed, Octets, Variant


def fixed_sizes(variant: Variant, most: int) -> list[Variant]:
    """Return a variant for each number of elements of its lists, with at most ``most`` bytes.

    A variant of a fixed size is returned as it is.
    """
    varying = [field for field in variant if field.type.varies]
    if not varying:
        return [variant]
    spans = [range(field.type.sizes[0], field.type.sizes[1] + 1) for field in varying]
    names = [field.name for field in varying]
    made = [_fixed(variant, dict(zip(names, counts))) for counts in product(*spans)]
    return [each for each in made if data_size(each) <= most]


def some(variants: Sequence[Variant]) -> list[Variant]:
    """Return the smallest two variants, one in the middle and the largest."""
    last = len(variants) - 1
    return [variants[index] for index in sorted({0, min(1, last), last // 2, last})]


def data_size(variant: Variant) -> int:
    """Return the number of data bytes of a variant of fixed size."""
    return sum(field.type.size for field in variant)


def _fixed(variant: Variant, counts: dict[str, int]) -> Variant:
    return tuple(_fixed_field(field, counts) for field in variant)


def _fixed_field(field: Field, counts: dict[str, int]) -> Field:
    if field.counts:
        return replace(field, const=counts[field.counts])
    type = field.type
    if field.name in counts and isinstance(type, Octets | Chars | Listed):
        size = counts[field.name]
        return replace(field, type=replace(type, least=size, most=size))
    return field
