"""The codec of the npm package agrees with the vectors of every edition."""

from __future__ import annotations

import pytest

import npm_package
from cobotwire import editions
from targets.typescript.comparison import compare

pytestmark = pytest.mark.skipif(bool(npm_package.missing()), reason=npm_package.missing())


@pytest.mark.parametrize("edition", editions.names())
def test_every_vector_agrees_with_codec(edition: str) -> None:
    found = compare(edition)
    assert found.differences == []
    assert found.vectors > 1000
    assert found.fields > 300
