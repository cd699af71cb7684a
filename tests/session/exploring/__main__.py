"""Explore all topics until a number of states was seen: ``make explore STATES=1000000``."""

from __future__ import annotations

import sys
from collections import Counter

from session.exploring.explorer import Search
from session.exploring.topics import TOPICS


def main(most: int) -> int:
    """Deepen the smallest search until ``most`` states were seen; return 1 if a promise breaks."""
    searches = {name: Search(topic) for name, topic in TOPICS.items()}

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


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1])))
