"""The purposes of the test cases, which results name only by their ids."""

from __future__ import annotations

from functools import cache

from cobotwire.conformance.catalogue.listing import SUITES
from cobotwire.conformance.report import Kind


@cache
def purposes(kind: Kind) -> dict[str, str]:
    """Return the purpose of each test case for a kind of subject."""
    return {case.id: case.purpose for suite in SUITES if suite.kind == kind for case in suite.cases}
