"""Replies outside any frame."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire.editions.mycobot import TABLE
from cobotwire.errors import ProtocolError, UsageError
from cobotwire.session.text import read, spell
from cobotwire.table import TextRequest

REPLY = TABLE.command("get_ssid_pwd").text
assert REPLY is not None
WORDS = st.text(st.characters(min_codepoint=32, max_codepoint=126), max_size=20)


@given(WORDS, WORDS)
def test_what_is_spelt_is_read_and_what_would_read_otherwise_is_refused(
    ssid: str, password: str
) -> None:
    assert REPLY is not None
    values = {"ssid": ssid, "password": password}
    ambiguous = f"{ssid} password: {password}".count(" password: ") != 1
    try:
        data = spell(REPLY, values)
    except UsageError:
        assert ambiguous
    else:
        assert not ambiguous
        assert read(REPLY, data) == values


@given(WORDS, WORDS)
def test_a_text_with_an_end_is_read_as_it_was_spelt(account: str, password: str) -> None:
    form = TextRequest(("'", "'("), ("account", "password"), ")")
    values = {"account": account, "password": password}
    try:
        assert read(form, spell(form, values)) == values
    except UsageError:
        assert "'(" in f"{account}'({password}".replace("'(", "", 1)


def test_text_that_is_no_printable_ascii_is_refused() -> None:
    assert REPLY is not None
    for word in ("caf\u00e9", "two\nlines", 5):
        with pytest.raises(UsageError, match="printable ASCII text"):
            spell(REPLY, {"ssid": word, "password": ""})  # type: ignore[dict-item]


@pytest.mark.parametrize(
    ("data", "detail"),
    [
        (b"ssid: caf\xc3\xa9 password: x", "no ASCII"),
        (b"SSID: a password: b", "starts with 'ssid: '"),
        (b"ssid: a", "0 times"),
        (b"", "starts with"),
    ],
)
def test_what_is_no_such_text_is_refused(data: bytes, detail: str) -> None:
    assert REPLY is not None
    with pytest.raises(ProtocolError, match=detail):
        read(REPLY, data)
