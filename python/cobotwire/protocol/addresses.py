"""Name the addresses of an edition, and state which devices may reply to each."""

from __future__ import annotations

from cobotwire.protocol.error_texts import error_text
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Address, Command, Table

# Repliers without an address of their own: any device, none, or one for all.
ANYBODY = -1
NOBODY = -2
SOMEBODY = -3


def replier_of(address: Address | None) -> int | None:
    """Return the address byte that a reply must have, or who replies to a broadcast."""
    if address is None:
        return None
    if address.replies == "own":
        return address.value
    return {"any": ANYBODY, "one": SOMEBODY, "none": NOBODY}[address.replies]


def addresses_of(table: Table) -> tuple[Address, ...]:
    """Return the addresses of an edition; those without a name are named by their number."""
    named = {address.value: address for address in table.addresses}
    return tuple(
        named.get(value) or Address(str(value), value, "", "own") for value in table.frame.addresses
    )


def devices_of(table: Table) -> tuple[Address, ...]:
    """Return the addresses that a single device has: those that are not broadcasts."""
    return tuple(address for address in addresses_of(table) if address.replies == "own")


def check_one_moves(table: Table, given: int | str | None) -> None:
    """Check that motions would go to a single device, and not to all by default.

    Raises:
        UsageError: none is given, and the edition's first address is a broadcast.
    """
    address = find_address(table, given)
    if given is None and address is not None and address.replies != "own":
        names = ", ".join(each.name for each in devices_of(table))
        message = error_text("all-would-move", names=names, name=address.name)
        raise UsageError("address", given, message=message)


def lacks_joints(table: Table, address: Address | None, command: Command) -> str:
    """Return why a device with fewer joints than its edition lacks a command; empty if it has it.

    A command with a value for each joint needs a device with all joints.
    """
    if address is None or address.joints in (0, table.joints):
        return ""
    fields = (f for each in (*command.request, *command.reply) for f in each.fields)
    if not any(f.many and len(f.cases[0].numbers) == table.joints for f in fields):
        return ""
    kind = "lacks-joints-but-one" if address.joints == 1 else "lacks-joints"
    return error_text(kind, count=table.joints, name=address.name, joints=address.joints)


def find_address(table: Table, given: int | str | None) -> Address | None:
    """Return an address by its byte or its name; given None, the edition's first one.

    The result is None if the edition has no addresses, and none is given.

    Raises:
        UsageError: the edition has no such address.
    """
    if given is None:
        return next(iter(addresses_of(table)), None)
    return named_address(table, given)


def named_address(table: Table, given: int | str) -> Address:
    """Return an address by its byte or its name.

    Raises:
        UsageError: the edition has no such address.
    """
    known = addresses_of(table)
    for address in known:
        if isinstance(given, str):
            if given.upper() == address.name.upper():
                return address
        elif not isinstance(given, bool) and given == address.value:
            return address
    if not known:
        message = error_text("no-addresses", edition=table.edition)
        raise UsageError("address", given, message=message)
    allowed = ", ".join(
        error_text("label", label=address.name, raw=address.value) for address in known
    )
    raise UsageError("address", given, allowed)


def address_name(table: Table, value: int) -> str:
    """Return the name of an address byte; the number, if the edition does not name it."""
    return next((a.name for a in addresses_of(table) if a.value == value), str(value))
