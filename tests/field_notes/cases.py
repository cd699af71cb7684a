"""All cases, in the order of the table."""

from __future__ import annotations

from field_notes import connections, noise, replies

GROUPS = {
    "Noise": noise.CASES,
    "Replies": replies.CASES,
    "One-way requests, broken lines, shared lines": connections.CASES,
}
CASES = {case.name: case for group in GROUPS.values() for case in group}
assert len(CASES) == sum(map(len, GROUPS.values())), "two cases have the same name"
