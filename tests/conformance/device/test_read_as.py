"""Bytes that were sent one after the other may hold a request with an unknown id."""

from __future__ import annotations

import pytest

from cobotwire.conformance.device.read_as import unknown_ids
from cobotwire.editions.mycobot import TABLE


@pytest.mark.parametrize(
    ("sent", "named"),
    [
        ("FE FE 02 20 FA FE FE 02 2B FA", ""),
        ("FE FE 02 FE FE 02 86 FA", "the unknown id FE in FE FE 02 FE"),
        ("FE FE 02 9A FA", "the unknown id 9A in FE FE 02 9A"),
        # FE FE inside the data of a legal request is a number, not a header.
        ("FE FE 06 21 01 FE FE 10 FA", ""),
        ("FE FE", ""),
    ],
)
def test_unknown_id_is_named_with_the_bytes_that_hold_it(sent: str, named: str) -> None:
    text = unknown_ids(TABLE, bytes.fromhex(sent))
    assert text.endswith(named)
    assert bool(text) is bool(named)
