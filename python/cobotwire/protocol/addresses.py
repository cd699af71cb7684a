"""Name the addresses of an edition, and say whose replies a request to each may have."""

from __future__ import annotations

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Address, Table

# Repliers that are no address.
ANYBODY = -1
NOBODY = -2


def replier_of(address: Address | None) -> int | None:
    """Return the address byte that a reply to an address must have, ANYBODY or NOBODY."""
    if address is None:
        return None
    if address.replies == "own":
        return address.value
    return ANYBODY if address.replies == "any" else NOBODY


def addresses_of(table: Table) -> tuple[Address, ...]:
    """Return the addresses of an edition; those without a name are named by their number."""
    named = {address.value: address for address in table.addresses}
    return tuple(
        named.get(value) or Address(str(value), value, "", "own") for value in table.frame.addresses
    )


def devices_of(table: Table) -> tuple[Address, ...]:
    """Return the addresses that a single device has: those that are no broadcast."""
    return tuple(address for address in addresses_of(table) if address.replies == "own")


def find_address(table: Table, given: int | str | None) -> Address | None:
    """Return an address by its byte or its name; given None, the edition's first one.

    The result is None if the edition has no addresses, and none is given.

    Raises:
        UsageError: the edition has no such address.
    """
    known = addresses_of(table)
    if given is None:
        return known[0] if known else None
    for address in known:
        if isinstance(given, str):
            if given.upper() == address.name.upper():
                return address
        elif not isinstance(given, bool) and given == address.value:
            return address
    if not known:
        message = f"edition {table.edition} has no addresses"
        raise UsageError("address", given, message=message)
    allowed = ", ".join(f"{address.name} ({address.value})" for address in known)
    raise UsageError("address", given, allowed)


def address_name(table: Table, value: int) -> str:
    """Return the name of an address byte; the number, if the edition does not name it."""
    return next((a.name for a in addresses_of(table) if a.value == value), str(value))
