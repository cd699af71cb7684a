"""Diagnose the traffic of shipped scenarios.

tests/client and tests/protocols check that our clients get correct values on these lines.
"""

from __future__ import annotations

import pytest

from cobotwire.diagnose import Finding, summarize
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator.faults import find
from diagnosing import diagnose
from faulty_talk import CODEC, GET_ANGLES, talk

BROKEN = {"nuls", "unrecognised", "text"}
# The number of requests, the noise that must be found, and the noise that may be found because the
# bytes of a broken frame are ambiguous.
SHOWN: dict[str, tuple[int, set[str], set[str]]] = {
    "servo-leaks": (4, {"servo"}, set()),
    "servo-leak-inside": (3, {"servo", "damaged-frame"}, BROKEN),
    "servo-checksum-fe": (2, {"servo"}, set()),
    "command-errors": (2, {"cmd-len-error"}, set()),
    "nuls": (3, {"nuls"}, set()),
    "panic": (6, {"damaged-frame", "panic", "nuls", "garbage"}, BROKEN),
    "wrong-baud": (3, {"garbage"}, BROKEN),
    "echo": (2, {"opposite-frame"}, set()),
    "corrupted-footers": (3, {"damaged-frame"}, BROKEN),
    "wrong-length": (3, {"damaged-frame"}, BROKEN),
    "merged-replies": (2, set(), set()),
    "stray-acks": (2, set(), set()),
    "other-frame-before-reply": (2, set(), set()),
    "pause-in-reply": (2, set(), set()),
    "pause-after-header": (2, set(), set()),
    "slow-line": (2, set(), set()),
    "usb-latency-timer": (2, set(), set()),
    "duplicated-replies": (2, set(), set()),
    "held-in-reset": (1, set(), set()),
}


@pytest.mark.parametrize("name", SHOWN)
def test_diagnosis_recognises_the_fault_of_a_scenario(name: str) -> None:
    number, certain, possible = SHOWN[name]
    scenario = find(name, TABLE)
    requests: list[bytes | float] = [GET_ANGLES, 1.0] * number
    played = talk(scenario.faults, requests, seed=scenario.seed)
    items = diagnose(CODEC, played.data, sent=GET_ANGLES * number)
    findings = [item for item in items if isinstance(item, Finding)]
    assert certain <= {each.kind for each in findings} <= certain | possible, summarize(findings)
    assert played.applied
