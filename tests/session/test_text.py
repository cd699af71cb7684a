"""Replies outside any frame."""

from __future__ import annotations

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from cobotwire.editions.mycobot import TABLE
from cobotwire.errors import ProtocolError
from cobotwire.session.text import read, spell

REPLY = TABLE.command("get_ssid_pwd").text
assert REPLY is not None
WORDS = st.text(st.characters(min_codepoint=32, max_codepoint=126), max_size=20)


@given(WORDS, WORDS)
def test_what_was_spelt_is_read_or_refused_but_never_read_wrongly(ssid: str, password: str) -> None:
    assert REPLY is not None
    values = {"ssid": ssid, "password": password}
    try:
        assert read(REPLY, spell(REPLY, values)) == values
    except ProtocolError:
        assume(" password: " in f"{ssid} password: {password}".replace(" password: ", "", 1))


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
