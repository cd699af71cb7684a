"""Samples contain both limits of every range, and are legal or illegal as their names say."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from cobotwire import editions
from cobotwire.conformance.located import LocatedNumber, is_list, located_numbers, picks
from cobotwire.conformance.samples import illegal_samples, plainest, samples
from cobotwire.conformance.samples.raw import RawValues, harmless_values
from cobotwire.protocol.table import Table, Variant


def _variants(table: Table) -> Iterator[Variant]:
    for command in table.commands:
        yield from (*command.request, *command.reply)


def _ends(located: LocatedNumber) -> set[int]:
    choices = located.field.choices or located.number.choices
    return set(choices) or {located.number.minimum, located.number.maximum}


def _is_legal(variant: Variant, raw_values: RawValues) -> bool:
    for field, row in zip(variant.fields, raw_values):
        case = variant.raw_case(field, raw_values)
        if case is None or not all(field.allows(n, raw) for n, raw in zip(case.numbers, row)):
            return False
    return True


@pytest.mark.parametrize("edition", editions.names())
def test_samples_are_legal_and_contain_both_limits_or_every_choice(edition: str) -> None:
    for variant in _variants(editions.load(edition).TABLE):
        found = [sample.raw_values for sample in samples(variant)]
        assert all(_is_legal(variant, each) for each in found)
        picked = next(picks(variant))
        for located in located_numbers(variant, picked):
            if located.index not in picked and not is_list(located.field):
                raw = {each[located.index][located.element] for each in found}
                assert _ends(located) <= raw, located.name


@pytest.mark.parametrize("edition", editions.names())
def test_illegal_samples_are_illegal(edition: str) -> None:
    for variant in _variants(editions.load(edition).TABLE):
        for sample in illegal_samples(variant):
            assert not _is_legal(variant, sample.raw_values), sample.name


@pytest.mark.parametrize("edition", editions.names())
def test_harmless_values_are_legal_and_contain_both_limits_or_every_choice(
    edition: str,
) -> None:
    for variant in _variants(editions.load(edition).TABLE):
        found = harmless_values(variant, {}, {})
        assert all(_is_legal(variant, each) for each in [*found, plainest(variant)])
        picked = next(picks(variant))
        for located in located_numbers(variant, picked):
            if located.index not in picked and not located.field.many:
                raw = {each[located.index][0] for each in found}
                assert _ends(located) <= raw, located.name
