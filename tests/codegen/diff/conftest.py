"""Build the small specs of the fixtures with the changes that a test needs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.model import Edition

HERE = Path(__file__).parent
Swaps = list[tuple[str, str]]
Build = Callable[..., Edition]


@pytest.fixture
def build(tmp_path: Path) -> Build:
    """Return a function that builds ``base`` or ``delta`` with some of its text replaced."""

    def built(swaps: Swaps = [], file: str = "base") -> Edition:  # noqa: B006 - only read
        base = (HERE / "base.yaml").read_text()
        folder = tmp_path / f"spec-{len(list(tmp_path.iterdir()))}"
        folder.mkdir()
        # A second copy of the base, for a delta whose base changes.
        for name in ("base", "former"):
            (folder / f"{name}.yaml").write_text(base)
        text = (HERE / f"{file}.yaml").read_text()
        for take, put in swaps:
            assert take in text, "the test must change something"
            text = text.replace(take, put)
        (folder / f"{file}.yaml").write_text(text)
        return build_edition(folder / f"{file}.yaml", folder)

    return built
