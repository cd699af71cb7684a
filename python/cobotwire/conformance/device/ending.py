"""What ends a case before its end."""

from __future__ import annotations


class Hopeless(Exception):
    """The rest of a case would show nothing new."""


class Unsupported(Exception):
    """The arm is not in a state, or not of a kind, in which this can be tried."""
