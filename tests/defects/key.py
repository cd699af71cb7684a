"""The key: every planted defect, and what a message must name. It is written before the runs."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ruamel.yaml import YAML

HERE = Path(__file__).parent
# The subjects, each with its own file; the titles are those of the page.
SUBJECTS = {
    "arm": "arm in plain Python",
    "closed_loop": "the same in a closed loop",
    "two_arms": "two of them on one line",
    "firmware": "firmware in C, on a pty",
    "server": "the maker's server",
    "client": "client in plain Python",
    "c_client": "client in C",
}
# A defect of the line as a whole: the message may be about any command.
ANY = "*"


class Defect(NamedTuple):
    """A planted defect.

    ``switch`` turns it on. ``what`` describes it. A message names it if it is about one of the
    commands in ``names``, or mentions one, and has all patterns in ``words``. ``line`` is what the
    referee does to replies, if the subject is a client.
    """

    subject: str
    switch: str
    what: str
    names: tuple[str, ...]
    words: tuple[str, ...]
    line: str = ""


def defects(*subjects: str) -> Iterator[Defect]:
    """Yield all defects of some subjects; without names, of all."""
    for subject in subjects or SUBJECTS:
        entries = YAML(typ="safe").load((HERE / f"key_{subject}.yaml").read_text("utf-8"))
        for switch, entry in entries.items():
            yield Defect(
                subject,
                switch,
                entry["what"],
                tuple(entry["names"]),
                tuple(entry["words"]),
                entry.get("line", ""),
            )
