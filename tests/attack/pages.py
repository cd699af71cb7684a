"""Let pages of ``cobotwire studio`` stop the arm while connections without the token are held."""

from __future__ import annotations

import time
from collections.abc import Callable
from random import Random

from attack.plans import Plan
from attack.tally import Tally
from studio.feeds import Feed, watching
from studio.held_headers import NEW_SECONDS, OPEN_SECONDS, WAYS, holding
from studio.studio_server import Studio, running

COUNTS = (100, 300, 1000)


def attack_studio(plan: Plan) -> Tally:
    """Run a plan: Stop over an open page and over new connections, in turn."""
    tally, draw = Tally(plan.profile.name), Random(f"{plan.seed} pages")
    count, way = draw.choice(COUNTS), draw.choice(sorted(WAYS))
    words = ("--allow-motion", "--rate", "5")
    with running(*words, edition=plan.edition) as studio, watching(studio) as feed:
        feed.state("hello")
        until = time.monotonic() + plan.seconds
        with holding(studio, count, way):
            while time.monotonic() < until and tally.calls < plan.calls:
                for limit, stop in (
                    (OPEN_SECONDS, lambda: _stop_of_page(feed)),
                    (NEW_SECONDS, lambda: _stop_anew(studio, feed)),
                ):
                    failed = _count(tally, limit, stop)
                    if failed:
                        tally.failures.append(f"{plan}: {count} hold {way}: {failed}")
    return tally


def _count(tally: Tally, limit: float, stop: Callable[[], bool]) -> str:
    """Count one Stop; return why it is forbidden, or an empty text."""
    tally.calls += 1
    start = time.monotonic()
    try:
        arrived = stop()
    except TimeoutError:
        tally.lost += 1
        return "Stop was never answered"
    except Exception as error:  # any: no page may see one
        tally.exceptions += 1
        return f"Stop failed: {error!r}"
    seconds = time.monotonic() - start
    if not arrived:
        tally.wrong += 1
        return "Stop was reported, but not sent"
    if seconds > limit:
        tally.late += 1
        return f"Stop took {seconds:.1f} s"
    tally.right += 1
    return ""


def _stop_of_page(feed: Feed) -> bool:
    """Press Stop on a page; return whether its frame was on the line."""
    feed.entries.clear()
    feed.wish("stop", number=1)
    assert feed.state("stopped") == {"number": 1, "error": ""}
    return _on_the_line(feed)


def _stop_anew(studio: Studio, feed: Feed) -> bool:
    """Send Stop over a new connection; return whether its frame was on the line."""
    feed.entries.clear()
    status = studio.post("/api/stop", {}).status
    assert status == 200, status
    return _on_the_line(feed)


def _on_the_line(feed: Feed) -> bool:
    end = time.monotonic() + OPEN_SECONDS
    while not any(each["l"] == "stop" for each in feed.entries):
        if time.monotonic() > end:
            return False
        feed.take()
    return True
