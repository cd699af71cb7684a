"""Reasons for differences that several of the maker's classes have."""

from __future__ import annotations

from robots.robot import Ruling

PORT = Ruling("'h' format", "a port is 1..65535; the maker packs a signed word")
TENTH = Ruling(
    "'float' object is not iterable", "a limit is any tenth of a degree; the maker takes whole ones"
)
KIND = Ruling(
    "NoneType", "the kind may be left out; the maker's check of a missing kind fails by mistake"
)
FREE = "a query or a reference is not a motion; the maker applies the limits of motion"
SPEED = "a speed of 0 is legal in this edition; the maker wants 1..100"
SIGN = "the document's sign rule: words reach to 33000; the maker packs -32768..32767"
SPAN = "a step may be as long as the wire allows; the maker compares it with the limits"
RETRIED = "the maker sends the frame and the text up to three times, without an acknowledgement"


def limits(shows: str) -> list[Ruling]:
    """Return the ruling for queries and references to which a class applies limits of motion."""
    return [Ruling(shows, FREE)]


# What a class of the 280's kind shares with others of its kind.
SETTERS = {"set_server_port": [PORT], "set_joint_min": [TENTH], "set_joint_max": [TENTH]}

# A pose that a simulated 280 reaches.
REACHED = ([243.5, -18.2, 206, -164.81, 14, -107.28], 50, 0)
EMPTY = "the maker returns -1 for a record of zeros, and nothing was recorded"
