"""The catalogue lists every test case; it has a new version when one of them changes."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cobotwire import editions
from cobotwire.conformance import Suite
from cobotwire.conformance.catalogue import HISTORY, VERSION, listing
from cobotwire.conformance.catalogue.history import CLAUSES
from cobotwire.conformance.device import SUITE
from conformance.device.testing import permissions, prepared


def test_present_version_has_the_digest_of_the_test_cases() -> None:
    assert listing.outdated() == ""
    assert [each.number for each in HISTORY] == list(range(1, VERSION + 1))


def _changed(**changes: object) -> Suite[object]:
    first, *rest = SUITE.groups
    return Suite("device", (replace(first, **changes), *rest))  # type: ignore[arg-type]  # any fields


@pytest.mark.parametrize(
    "changed",
    [
        _changed(sends="something else"),
        _changed(subject="each command"),
        _changed(permission=frozenset({"motion"})),
        _changed(cases=SUITE.groups[0].cases[1:]),
        _changed(
            cases=(replace(SUITE.groups[0].cases[0], purpose="x"), *SUITE.groups[0].cases[1:])
        ),
    ],
    ids=["what is sent", "subject", "permission", "cases", "purpose"],
)
def test_changed_test_case_needs_a_new_version(
    changed: Suite[object], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(listing, "SUITES", (changed, *listing.SUITES[1:]))
    assert f"CatalogueVersion({VERSION + 1}, " in listing.outdated()


def test_clause_is_never_given_to_another_test_case(monkeypatch: pytest.MonkeyPatch) -> None:
    clauses = CLAUSES
    numbers = {case: number for number, case in enumerate(clauses, 1)}
    for changed, message in (
        ((clauses[1], clauses[0], *clauses[2:]), "are not those of version 1"),
        (clauses[1:], "are not those of version 1"),
        ((*clauses, clauses[0]), "CLAUSES names a test case twice"),
        ((*clauses, "later"), ""),
    ):
        monkeypatch.setattr(listing, "CLAUSES", changed)
        monkeypatch.setattr(listing, "NUMBERS", dict.fromkeys(changed, 0))
        assert message in listing.misnumbered()
    monkeypatch.setattr(listing, "CLAUSES", clauses)
    numbers.pop("stops")
    monkeypatch.setattr(listing, "NUMBERS", numbers)
    assert listing.misnumbered() == "add stops at the end of CLAUSES in catalogue/history.py"


def test_every_group_says_what_it_tests_and_sends() -> None:
    for suite in listing.SUITES:
        for group in suite.groups:
            assert group.subject, group.name
            assert group.sends or suite.kind == "client" or group.body is None, group.name


def test_page_of_an_edition_lists_the_test_cases_of_a_run() -> None:
    table = editions.load("mycobot").TABLE
    listed = {
        (each.group.name, each.command.name if each.command else "", case.id)
        for each in listing.selected(table)
        for case in each.cases
        if not each.group.declared
    }
    tester = prepared(table, permissions=permissions())
    run = {
        (result.group, result.command, result.case)
        for step in tester.steps()
        for result in tester.results_without_run(step)
    }
    assert listed == run
