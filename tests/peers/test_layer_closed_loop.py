"""Our classes of the Mercury and the Pro robots, compared with the maker's."""

from __future__ import annotations

import pytest

from layer_comparison import compare
from layer_replies import compare_replies
from layer_robots import CLOSED_LOOP
from layer_rulings import BY_TCP

# One of so many methods; `make layer` compares all. Of each method, one of so many calls.
SAMPLE, SAMPLE_BY_TCP, STRIDE = 6, 20, 12

# It reads the language of the system in a way that Python deprecates.
pytestmark = pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")
robots = pytest.mark.parametrize("name", CLOSED_LOOP)


def sample_of(name: str) -> int:
    return SAMPLE_BY_TCP if name in BY_TCP.values() else SAMPLE


@robots
def test_frames_and_results_equal_those_of_the_makers_class(name: str) -> None:
    found = compare(CLOSED_LOOP[name], STRIDE, sample_of(name))
    assert found.open == []
    assert found.equal > 2


@pytest.mark.parametrize("name", ["Mercury (B1, X1)", "Pro400", "Pro630", "Pro450Client"])
def test_results_of_the_same_reply_equal_those_of_the_makers_class(name: str) -> None:
    # The other classes have the methods of these.
    equal, _, wrong = compare_replies(CLOSED_LOOP[name], 2 * SAMPLE)
    assert wrong == []
    assert equal > 10
