"""A run can be repeated from the options in its report."""

from __future__ import annotations

import pytest

from cobotwire.conformance.client import ClientOptions
from cobotwire.conformance.codec import CodecOptions
from cobotwire.conformance.device import RunOptions
from cobotwire.conformance.options import Options
from cobotwire.protocol.errors import UsageError

KNOWN = {"expected": "a/* why", "expected_name": "known.txt"}
GIVEN = [
    ClientOptions("lost", 4, 2.5, 40.0, True, "get_angles", "calls.txt", **KNOWN),
    CodecOptions("./codec --stdio", "decode-*", 0.5, 2, **KNOWN),
    RunOptions("setting", 30, "-10:10", 2, 1, "get_color", "LEFT", 50.5, 115200, **KNOWN),
]


@pytest.mark.parametrize("given", GIVEN, ids=lambda each: each.kind)
def test_options_are_read_back_from_a_report(given: Options) -> None:
    assert type(given).of_report(given.for_report()) == given
    assert type(given)().for_report() == {}


@pytest.mark.parametrize("given", GIVEN, ids=lambda each: each.kind)
@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"speed": "3"}, "the report has an option that a run on a KIND does not have: speed"),
        ({"repeat": "often", "every": "often"}, "its option|an option"),
    ],
)
def test_options_that_a_run_cannot_have_are_rejected(
    given: Options, options: dict[str, str], message: str
) -> None:
    with pytest.raises(UsageError, match=message.replace("KIND", given.kind)):
        type(given).of_report(options)
