"""Says why a class or method of the maker's library has no counterpart."""

from __future__ import annotations

import json
from functools import lru_cache
from pkgutil import get_data

# The names that no class of ours has.
_ALL = "*"
# Why classes and modules have no counterpart, by how their names begin, in lower case without "_".
_ELSEWHERE = "which no edition describes; run it with the maker's library"
_OWN_FRAMES = f"with frames of its own, {_ELSEWHERE}"
_INSIDE = "it is a part of the library itself; use the class of the robot"
OTHERS = {
    "elephantrobot": f"it sends texts over TCP to a controller, {_ELSEWHERE}",
    "ultraarm": f"these robots take G-code and other texts, {_ELSEWHERE}",
    **dict.fromkeys(
        ["myagv", "mercurychassis", "chassiscontrol"], f"it is a vehicle {_OWN_FRAMES}"
    ),
    "conveyor": f"it is a conveyor belt {_OWN_FRAMES}",
    "exoskeleton": f"it is a controller that a person wears, {_OWN_FRAMES}",
    "myarmmcontrol": "it is another class for the myArm M; use MyArmM",
    "mybuddybluetooth": "there is no transport for Bluetooth; use MyBuddy or MyBuddySocket",
    "mybuddyemoticon": "it shows videos on the robot's display, and sends nothing to an arm",
    "pro320modbus": "it translates Modbus registers into calls of MyCobot320; use that",
    **dict.fromkeys(["commandgenerator", "mybuddycommandgenerator"], _INSIDE),
    **dict.fromkeys(["generate", "interface", "common"], _INSIDE),
}


def why_no(name: str) -> str:
    """Return why a class or module of the library has no counterpart; empty if it is not known."""
    key = name.rpartition(".")[2].lower().replace("_", "")
    found = (why for start, why in OTHERS.items() if key.startswith(start))
    return next((f"cobotwire has no {name}: {why}" for why in found), "")


def why_absent(kind: type, name: str) -> str:
    """Return why a class has no counterpart of a name; empty if the maker has no such name."""
    if name.startswith("_"):
        return ""
    reasons = (absent(each).get(name, "") for each in [*_names(kind), _ALL])
    return next(filter(None, reasons), "")


def absent(kind: str) -> dict[str, str]:
    """Return the names that a class lacks, with why; given ``*``, those that all classes lack."""
    return _reasons().get(kind, {})


def _names(kind: type) -> list[str]:
    return [base.__name__ for base in kind.__mro__]


@lru_cache
def _reasons() -> dict[str, dict[str, str]]:
    # A program may have imported this package under the name of the library, without its folder.
    data = get_data("cobotwire", "pymycobot/absent.json")
    assert data is not None, "the loader of the package reads files"
    found: dict[str, dict[str, str]] = json.loads(data)
    return found
