"""The choices of a quantity are checked in a field, in a case, and in a value type."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

import small_specs
from cobotwire.protocol.errors import ProtocolError, UsageError
from strategies import CODECS
from targets.expected import codec_of_edition

COMMANDS = """
set_x:
  id: 0x10
  title: Set x
  doc: Sets x.
  safety: setting
  request:
    - {name: plain, type: level}
    - {name: mode, type: mode}
    - name: picked
      doc: What the mode needs.
      selector: mode
      cases: {STEADY: {type: percent}, BLINK: {type: level}}
    - {name: both, type: levels}
"""
LEVEL = "  quantities:\n    level: {wire: byte, choices: [1, 2, 4], doc: A level.}\n"
LEVELS = """\
  values:
    levels: {class: Levels, doc: Levels., items: {inner: level, outer: percent}}
"""


@pytest.fixture
def edition(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    head = small_specs.HEAD.replace("  quantities:\n", LEVEL).replace("  values:\n", LEVELS)
    monkeypatch.setattr(small_specs, "HEAD", head)
    return small_specs.build(tmp_path, COMMANDS)


@pytest.mark.parametrize("name", CODECS)
def test_value_between_choices_is_refused_and_named(edition: Any, name: Any) -> None:
    codec = codec_of_edition(edition, name)
    right = codec.encode("set_x", "request", (4, 1, 4, (4, 3)))
    assert codec.decode("request", right).values == (4, 1, 4, (4, 3))
    # In the other case the range of the percentage applies.
    codec.encode("set_x", "request", (4, 0, 3, (4, 3)))
    wrong = {(3, 1, 4, (4, 3)): "plain", (4, 1, 3, (4, 3)): "picked", (4, 1, 4, (3, 3)): "both"}
    for values, argument in wrong.items():
        with pytest.raises(UsageError, match=re.escape("1, 2, 4")) as refused:
            codec.encode("set_x", "request", values)
        assert refused.value.argument.startswith(argument)
    for at in (4, 6, 7):
        data = bytearray(right)
        data[at] = 3
        with pytest.raises(ProtocolError, match=re.escape("1, 2, 4")) as unread:
            codec.decode("request", bytes(data))
        assert (unread.value.reason, unread.value.offset) == ("bad-value", at)
