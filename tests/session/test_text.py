"""Text outside any frame is encoded, decoded, and rejected if it has another format."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import TextRequest
from cobotwire.session import Exchange, ReplyRejected, RetryPolicy
from cobotwire.session.request import RequestEncoder
from cobotwire.session.text import TEXT_LIMIT, decode, encode
from session.one_caller import submit

REPLY = TABLE.command("get_ssid_pwd").text
assert REPLY is not None
WORDS = st.text(st.characters(min_codepoint=32, max_codepoint=126), max_size=20)


@given(WORDS, WORDS)
def test_encoded_text_decodes_and_ambiguous_text_is_rejected(ssid: str, password: str) -> None:
    assert REPLY is not None
    values = {"ssid": ssid, "password": password}
    ambiguous = f"{ssid} password: {password}".count(" password: ") != 1
    try:
        data = encode(REPLY, values)
    except UsageError:
        assert ambiguous
    else:
        assert not ambiguous
        assert decode(REPLY, data) == values


@given(WORDS, WORDS)
def test_text_with_a_suffix_decodes_as_it_was_encoded(account: str, password: str) -> None:
    variant = TextRequest(("'", "'("), ("account", "password"), ")")
    values = {"account": account, "password": password}
    try:
        assert decode(variant, encode(variant, values)) == values
    except UsageError:
        assert "'(" in f"{account}'({password}".replace("'(", "", 1)


def test_text_that_is_not_printable_ascii_is_rejected() -> None:
    assert REPLY is not None
    for word in ("caf\u00e9", "two\nlines", 5):
        with pytest.raises(UsageError, match="printable ASCII text"):
            encode(REPLY, {"ssid": word, "password": ""})  # type: ignore[dict-item]


@pytest.mark.parametrize(
    ("data", "detail"),
    [
        (b"ssid: caf\xc3\xa9 password: x", "not ASCII"),
        (b"SSID: a password: b", "does not start with 'ssid: '"),
        (b"ssid: a", "0 times"),
        (b"", "does not start with"),
    ],
)
def test_text_in_another_format_is_rejected(data: bytes, detail: str) -> None:
    assert REPLY is not None
    with pytest.raises(ProtocolError, match=detail):
        decode(REPLY, data)


@pytest.mark.parametrize("data", [b"'a'(b", b"'"])
def test_text_without_its_suffix_is_rejected(data: bytes) -> None:
    variant = TextRequest(("'", "'("), ("account", "password"), ")")
    with pytest.raises(ProtocolError, match=r"the text does not end with '\)'"):
        decode(variant, data)


@pytest.mark.usefixtures("repeated_in_rust")
def test_text_that_is_too_long_is_rejected(codec: Codec) -> None:
    exchange = Exchange(codec)
    request = RequestEncoder(codec).encode("get_ssid_pwd", ())
    submit(exchange, request, 0.0, RetryPolicy(attempts=1), wait=0.5)
    assert exchange.outgoing(0.0, drained=True)
    exchange.receive(b"ssid: a password: b" + b"x" * TEXT_LIMIT, 0.1)
    [*_, ended] = exchange.wake(0.4)
    assert isinstance(ended, ReplyRejected)
    assert "longer than" in str(ended.error)
