"""Reasons for differences that several of the maker's classes have."""

from __future__ import annotations

from robots.robot import Ruling

PORT = Ruling("'h' format", "a port is 1..65535; the maker packs a signed word")
KIND = Ruling(
    "NoneType", "the kind may be left out; the maker's check of a missing kind fails by mistake"
)
FREE = "a query or a reference is not a motion; the maker applies the limits of motion"
SPEED = "a speed of 0 is legal in this edition; the maker wants 1..100"
SIGN = "the document's sign rule: words reach to 33000; the maker packs -32768..32767"
RETRIED = "the maker sends the frame and the text up to three times, without an acknowledgement"


def limits(shows: str) -> list[Ruling]:
    """Return the ruling for queries and references to which a class applies limits of motion."""
    return [Ruling(shows, FREE)]


# A pose that a simulated 280 reaches.
REACHED = ([243.5, -18.2, 206, -164.81, 14, -107.28], 50, 0)
EMPTY = "the maker returns -1 for a record of zeros, and nothing was recorded"
