"""Generate the packages of the protocols once, and import them."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import pytest

import small_specs
from targets.specs import edition_of


@pytest.fixture(scope="session")
def package(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Any]:
    """Return a function that generates a protocol's package and imports it."""
    folder = tmp_path_factory.mktemp("protocols")
    return cache(lambda name: small_specs.package(folder, edition_of(name)))
