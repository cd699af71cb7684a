"""Run each line of the field notes with both clients, on a real pty and over real TCP.

The cases are data in ``tests/field_notes``; ``make table`` shows pymycobot's results.
"""

from __future__ import annotations

import re
import threading

import pytest

import vectors
from cobotwire.editions import mycobot, mycobot280
from field_notes.case import DONE, Case
from field_notes.cases import CASES
from field_notes.line import line_of
from field_notes.notes import ELSEWHERE, FIGURES, NOTES
from field_notes.play import Outcome, play

FIELD_NOTES = vectors.ROOT.parent / "shared" / "protocol" / "field-notes.md"
RUNS = [
    pytest.param(case, transport, who, id=f"{case.name}, {transport}, {who}")
    for case in CASES.values()
    for transport in case.transports
    for who in ("blocking", "asyncio")
]


def _played(case: Case, who: str, url: str) -> tuple[list[Outcome], float]:
    """Run each of the case's clients in a separate thread."""
    outcomes: list[Outcome] = []
    longest: list[float] = []

    def work(client: int) -> None:
        ended, seconds = play(case, who, url, client)
        outcomes.extend(ended)
        longest.append(seconds)

    threads = [threading.Thread(target=work, args=(client,)) for client in range(case.clients)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return outcomes, max(longest)


# A client repeats a query after 167 ms, so a stall of the machine would change the counts.
@pytest.mark.stall(0.08)
@pytest.mark.parametrize(("case", "transport", "who"), RUNS)
def test_call_on_a_field_notes_line_ends_with_the_verdict_of_its_case(
    case: Case, transport: str, who: str
) -> None:
    with line_of(case, transport) as line:
        outcomes, seconds = _played(case, who, line.url)
        line.settle(case.requests or 0)
    verdicts = [outcome.verdict for outcome in outcomes]
    if case.clients > 1:
        verdicts.sort(key=case.verdicts.index)
    assert verdicts == list(case.verdicts), outcomes
    assert seconds < case.within
    assert line.garbled == 0
    if case.requests is not None:
        assert len(line.frames) == case.requests
    for call in case.calls:
        if call.right == DONE and call.sends:
            assert line.frames.count(call.sends) == 1


def test_no_edition_has_the_query_that_froze_an_arm() -> None:
    for edition in (mycobot, mycobot280):
        assert 0x19 not in {command.id for command in edition.TABLE.commands}


def test_every_field_note_has_a_case_or_names_its_test() -> None:
    named = {note for case in CASES.values() for note in case.notes}
    assert named | set(ELSEWHERE) | set(FIGURES) == set(NOTES)
    for case in CASES.values():
        assert case.notes, case.name
    for place in ELSEWHERE.values():
        path, _, name = place.partition("::")
        assert f"def {name}(" in (vectors.ROOT / path).read_text(), place


@pytest.mark.skipif(
    not FIELD_NOTES.exists(), reason="the field notes are outside the repository, and absent here"
)
def test_quoted_pieces_cover_all_field_notes() -> None:
    text = " ".join(FIELD_NOTES.read_text().split("\n## ", 1)[1].split())
    for key, piece in NOTES.items():
        assert piece in text, key
        text = text.replace(piece, "")
    left = re.sub(r"Noise seen on .*? line|## Timing|## What the usual .*? port\)", "", text)
    left = left.replace(
        "These are the cases that this project exists to end: each belongs in the tests.", ""
    )
    assert re.findall(r"\w+", left) == [], left
