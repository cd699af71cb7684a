"""Messages that share an id and a size: the errors of their values, and which one is encoded.

``tests/found/frames.txt`` states how each frame is decoded, or why it is rejected.
"""

from __future__ import annotations

import pytest

from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import ProtocolError, UsageError
from json_tables import codec_of


@pytest.fixture(params=["reference", "native"])
def alike(request: pytest.FixtureRequest) -> Codec:
    """Return a codec of the sample; each test runs with both codecs."""
    return codec_of("alike", request.param)


def test_error_is_that_of_the_first_command_unless_one_is_named(alike: Codec) -> None:
    with pytest.raises(ProtocolError, match="set_left: side is 3; allowed: 1"):
        alike.decode("request", bytes.fromhex("FE FE 04 60 03 05 FA"))
    with pytest.raises(ProtocolError, match="set_right: side is 1; allowed: 2"):
        alike.decode("request", bytes.fromhex("FE FE 04 60 01 05 FA"), of="set_right")
    with pytest.raises(UsageError, match="did you mean jog"):
        alike.decode("request", b"", of="jogg")


def test_first_variant_that_allows_the_values_is_encoded(alike: Codec) -> None:
    assert alike.encode("jog", "request", (5,))[4] == 5
    assert alike.encode("jog", "request", (25,))[4] == 25
    assert alike.encode("jog", "request", (25,), variant=1)[4] == 25
    with pytest.raises(UsageError, match=r"low is 15; allowed: a whole number 0\.\.9"):
        alike.encode("jog", "request", (15,))
    with pytest.raises(UsageError, match=r"high is 5; allowed: a whole number 20\.\.29"):
        alike.encode("jog", "request", (5,), variant=1)
    with pytest.raises(UsageError, match=r"1 value given for the .*; it takes \(low\) or \(high\)"):
        alike.encode("jog", "request", (5,), variant=2)
