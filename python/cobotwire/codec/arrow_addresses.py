"""Make the Arrow column that says which device each message belongs to."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pyarrow as pa

from cobotwire.codec.arrow_cells import flat, named
from cobotwire.protocol.addresses import addresses_of
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table

# The name of the column.
ADDRESS = "address"


def with_address(leading: Mapping[str, Any], table: Table, address: memoryview) -> dict[str, Any]:
    """Return leading columns, and one with the name of a device for each address byte.

    The new column follows the column ``offset``. Without a column ``offset``, it is the last one.

    Raises:
        UsageError: a leading column is called ``address``.
    """
    if ADDRESS in leading:
        message = f"a table of {table.edition} has a column {ADDRESS}: rename the leading one"
        raise UsageError("leading", ADDRESS, message=message)
    names = [*leading]
    place = names.index("offset") + 1 if "offset" in names else len(names)
    found = dict(leading)
    found[ADDRESS] = _names(table, address)
    names.insert(place, ADDRESS)
    return {name: found[name] for name in names}


def address_field(table: Table) -> Any:
    """Return the field of the column; its metadata has the byte of each name, as an enum's has."""
    values = ", ".join(f"{each.name}={each.value}" for each in addresses_of(table))
    type = _names(table, memoryview(b"")).type
    return pa.field(ADDRESS, type, nullable=False, metadata={"values": values})


def _names(table: Table, address: memoryview) -> Any:
    return named(flat(address), {each.name: each.value for each in addresses_of(table)})
