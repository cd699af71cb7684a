"""All cases, in the order of the table."""

from __future__ import annotations

from field_notes import noise, orders, replies

GROUPS = {
    "Noise": noise.CASES,
    "Replies": replies.CASES,
    "Orders, broken lines, shared lines": orders.CASES,
}
CASES = {case.name: case for group in GROUPS.values() for case in group}
assert len(CASES) == sum(map(len, GROUPS.values())), "a name stands for one case"
