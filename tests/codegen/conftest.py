"""Fixtures of the generator's tests."""

from __future__ import annotations

import pytest


@pytest.fixture(scope="session")
def mypy_cache(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Return an option of mypy that lets its runs share one cache of installed packages."""
    return f"--cache-dir={tmp_path_factory.mktemp('mypy')}"
