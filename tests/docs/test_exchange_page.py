"""The page about the exchange names a test for each promise."""

from __future__ import annotations

import re

import vectors


def test_every_test_that_the_page_names_exists() -> None:
    text = (vectors.ROOT / "docs" / "contribute" / "exchange.md").read_text("utf-8")
    named = re.findall(r"`(tests/[\w/]+\.py)::(\w+)`", text)
    assert len(named) >= text.split("## The limits")[0].count("\n| ") - 12
    for path, name in named:
        source = (vectors.ROOT / path).read_text("utf-8")
        assert re.search(rf"\b(?:def|class) {name}\b", source), f"{path}::{name}"
