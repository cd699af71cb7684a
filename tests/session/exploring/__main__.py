"""Explore all topics until so many states were seen: ``make explore STATES=1000000``."""

from __future__ import annotations

import sys
from collections import Counter

from session.exploring.explorer import Search
from session.exploring.topics import TOPICS


def main(most: int) -> int:
    """Deepen the search with the fewest states to continue, again and again; return 1 if broken."""
    searches = {name: Search(topic) for name, topic in TOPICS.items()}
    found, states = "", 0
    while not found and states < most:
        name, search = min(searches.items(), key=lambda each: len(each[1].frontier))
        search.deepen(len(search.seen) + most - states)
        found, states = search.found, sum(len(each.seen) for each in searches.values())
        if sys.stderr.isatty():
            print(f"\r{states:,} states, {name} depth {search.depth}   ", end="", file=sys.stderr)
    limits = sum((search.limits for search in searches.values()), Counter[str]())
    events = sum(search.events for search in searches.values())
    depths = ", ".join(f"{name} {search.depth}" for name, search in searches.items())
    met = ", ".join(f"{limit} {count:,}" for limit, count in limits.most_common())
    print(
        f"{states:,} states, {events:,} events, every order of up to: {depths}; "
        f"{int(bool(found))} broken promises; limits met: {met}"
    )
    print(found, end="\n" if found else "")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1])))
