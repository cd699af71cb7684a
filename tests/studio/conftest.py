"""Skip the tests of the studio where the JavaScript that it needs could not be fetched."""

from __future__ import annotations

from pathlib import Path

import pytest

from cobotwire.studio.extras import CURVES
from vectors import ROOT

HERE = Path(__file__).parent
AXE = ROOT / "target" / "front-end" / "axe.min.js"
FETCHED = CURVES.is_file() and AXE.is_file()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the tests of this folder."""
    reason = "uPlot or axe-core is missing: `make front-end` could not reach the npm registry"
    for item in items:
        if not FETCHED and item.path.is_relative_to(HERE):
            item.add_marker(pytest.mark.skip(reason=reason))
