"""Explore all topics until a number of states was seen: ``make explore STATES=1000000``.

With ``RUST=1`` the exchange of the Rust core repeats each sequence, and must have the same states.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from session.exploring.explorer import Search
from session.exploring.topics import TOPICS, Topic


def main(most: int, search_of: Callable[[Topic], Search] = Search) -> int:
    """Deepen the smallest search until ``most`` states were seen; return 1 if a promise breaks."""
    searches = {name: search_of(topic) for name, topic in TOPICS.items()}

    def states() -> int:
        return sum(len(search.seen) for search in searches.values())

    def report() -> None:
        if sys.stderr.isatty():
            print(f"\r{states():,} states, {name} {search.depth + 1}   ", end="", file=sys.stderr)

    found = ""
    while not found and (left := most - states()) > 0:
        name, search = min(searches.items(), key=lambda each: len(each[1].frontier))
        search.deepen(len(search.seen) + left, report)
        found = search.found
    if sys.stderr.isatty():
        print(file=sys.stderr)
    events = sum(search.events for search in searches.values())
    depths = ", ".join(f"{name} {search.depth}" for name, search in searches.items())
    limits = sum((search.limits for search in searches.values()), Counter[str]())
    met = ", ".join(f"{limit} {count:,}" for limit, count in limits.most_common())
    print(f"{states():,} states, {events:,} events, every order of up to: {depths}")
    print(f"{1 if found else 0} broken promises; limits met: {met or 'none'}")
    print(found, end="\n" if found else "")
    return 1 if found else 0


def main_twins(most: int) -> int:
    """Explore both exchanges alike."""
    from probe import Probe
    from session.twin_search import TwinSearch, edition

    probe = Probe()
    with TemporaryDirectory() as folder:
        path = edition(Path(folder))
        return main(most, lambda topic: TwinSearch(topic, path, probe.ask))


if __name__ == "__main__":
    sys.exit((main_twins if "rust" in sys.argv else main)(int(sys.argv[1])))
