"""Fixtures of the generator's tests."""

from __future__ import annotations

import pytest


@pytest.fixture(scope="session")
def mypy_cache(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Return the option of mypy that makes its runs share what they know of installed packages."""
    return f"--cache-dir={tmp_path_factory.mktemp('mypy')}"
