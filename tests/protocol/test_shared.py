"""What depends only on a table is computed once for all clients of an edition."""

from __future__ import annotations

import gc
import weakref

from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE, AsyncMyCobot280
from cobotwire.protocol.shared import KEPT, once_per_table
from cobotwire.protocol.table import Table


class Computed:
    """A result that can have weak references."""


def test_result_is_computed_once_for_each_table() -> None:
    compute = once_per_table(lambda table: Computed())
    same = TABLE._replace()
    assert same == TABLE
    assert compute(TABLE) is compute(TABLE)
    # Another table may change what the codec does, so equal ones are not compared.
    assert compute(same) is not compute(TABLE)


def test_results_for_tables_that_are_no_longer_used_are_dropped() -> None:
    compute = once_per_table(lambda table: Computed())
    first = weakref.ref(compute(TABLE._replace()))
    assert first() is not None
    for _ in range(KEPT):
        compute(TABLE._replace())
    gc.collect()
    assert first() is None


def test_clients_of_an_edition_share_one_codec() -> None:
    for name in ("reference", "native"):
        assert codecs.load(TABLE, name) is codecs.load(TABLE, name)
    one, other = (AsyncMyCobot280("socket://127.0.0.1:9") for _ in range(2))
    assert one._settings.codec is other._settings.codec


def test_codec_of_a_table_with_other_limits_is_another_one() -> None:
    narrower: Table = TABLE._replace(commands=TABLE.commands[:1])
    assert codecs.load(narrower) is not codecs.load(TABLE)
    assert codecs.load(narrower).table is narrower
