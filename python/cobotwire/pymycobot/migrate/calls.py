"""Says how each call of the maker's library is written for our clients."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from inspect import Parameter, isfunction, signature
from typing import Any

import cobotwire
import cobotwire.pymycobot
from cobotwire.protocol.table import Table
from cobotwire.pymycobot.layer.absent import absent
from cobotwire.pymycobot.layer.calling import Method
from cobotwire.pymycobot.layer.data import NAMES
from cobotwire.pymycobot.layer.stated import class_row, methods

# The TCP port of most classes.
TCP_PORT = 9000
_LAYER = "cobotwire.pymycobot.layer."


@dataclass(frozen=True, slots=True)
class Call:
    """A method of the library, and the method of ours that replaces it.

    Attributes:
        calls: our method.
        parameters: the library's parameters in their order, each with its default as text.
        arguments: our arguments in their order: the library's parameter, and our default.
        result: how the library gives the result.
        gives: how to convert our result to the library's: ``same``, ``int``, ``list``,
            ``ints``; ``nothing`` if we have no result; ``parts`` if a person must convert it.
        keywords: our arguments that are passed only by keyword.
        address: the library's parameter that selects the device; empty if no parameter does.
        by_hand: whether a helper of the layer has the method, not the generated class.
    """

    calls: str
    parameters: dict[str, str]
    arguments: dict[str, tuple[str, str]]
    result: str = "plain"
    gives: str = "nothing"
    keywords: tuple[str, ...] = ()
    address: str = ""
    by_hand: bool = False


@dataclass(frozen=True, slots=True)
class LibraryClass:
    """A class of the library.

    Attributes:
        name: its name.
        opens: what its constructor opens.
        constructor: the parameters of its constructor.
        native: our class.
        on_ports: another class of ours, and the ports on which it is needed; often empty.
        joints: the joints of the robot.
        devices: our attribute for each address of the robot, by the number of the address.
        home: the call of ours that does what ``go_home`` does; empty if that depends on arguments.
        methods: its methods.
        absent: why names have no counterpart.
    """

    name: str
    opens: str
    constructor: tuple[str, ...]
    native: str
    on_ports: tuple[str, ...]
    joints: int
    devices: dict[str, str]
    home: str
    methods: dict[str, Call]
    absent: dict[str, str]

    def call(self, method: str) -> Call | None:
        """Return how a method is called in our client; None if no single call does the same."""
        found = self.methods.get(method)
        if found is None or not self.has(method) or not hasattr(self.client, found.calls):
            return None
        # Helpers of the layer send something else than the command of that name.
        return found if found.by_hand or not self.is_by_hand(method) else None

    def called(self, name: str) -> Call | None:
        """Return the library's method that a method of our client replaces; None if none is."""
        return next((each for each in self.methods.values() if each.calls == name), None)

    def has(self, method: str) -> bool:
        """Return whether the library's class has a method."""
        return hasattr(self.layer, method)

    def is_method(self, name: str) -> bool:
        """Return whether a name is a method of the library's class, not an attribute."""
        return not name.startswith("_") and isfunction(getattr(self.layer, name, None))

    def is_by_hand(self, method: str) -> bool:
        """Return whether the layer does more for a method than to send one command."""
        return bool(getattr(self.layer, method).__module__.startswith(_LAYER))

    def default(self, parameter: str) -> object:
        """Return the default of a parameter of the constructor; None without a default."""
        found = signature(self.layer).parameters[parameter].default
        return None if found is Parameter.empty else found

    @property
    def usual(self) -> int:
        """The TCP port or the baud rate of a constructor that leaves it out."""
        table: Table = getattr(self.client, "table")  # noqa: B009 - the class is not known here
        return TCP_PORT if self.opens == "socket" else table.baudrate

    @property
    def client(self) -> type:
        """Our class."""
        found: type = getattr(cobotwire, self.native)
        return found

    @property
    def layer(self) -> type:
        """Our class that has the library's methods."""
        found: type = getattr(cobotwire.pymycobot, self.name)
        return found


def _waited(kind: str, parameters: dict[str, str], *names: str, address: str = "") -> Call:
    given = [each for each in parameters if each != address]
    arguments = {name: (each, "") for name, each in zip(names, given)}
    arguments["timeout"] = ("timeout", "")
    keywords = ("timeout",)
    return Call(f"move_{kind}", parameters, arguments, "plain", "nothing", keywords, address, True)


def _waits(timeout: str = "15", address: str = "", mode: str = "0") -> dict[str, Call]:
    """Return the methods that wait for the end of a motion.

    The default of the mode is empty if the class has no default, and None if its robot has no mode.
    """
    before = {address: ""} if address else {}
    angles = {**before, "degrees": "", "speed": "", "timeout": timeout}
    path = {"mode": mode} if mode else {}
    coords = {**before, "coords": "", "speed": "", **path, "timeout": "15"}
    names = ["coords", "speed", *(["mode"] if mode == "0" else [])]
    return {
        "sync_send_angles": _waited("angles", angles, "angles", "speed", address=address),
        "sync_send_coords": _waited("coords", coords, *names, address=address),
    }


# Methods that send several requests and have a counterpart in our clients: of all classes, and of
# the layer's helpers by name.
_SEVERAL = {**_waits(), "close": Call("close", {}, {}, gives="same", by_hand=True)}
_OF_HELPERS = {
    "Limbs": {
        **_waits(address="id"),
        "get_base_coords": Call("get_base_coords", {}, {}, gives="parts", by_hand=True),
        "set_encoders": Call(
            "set_encoders",
            {"id": "", "encoders": "", "speed": ""},
            {"encoders": ("encoders", ""), "speed": ("speed", "")},
            result="one_speed",
            keywords=("speed",),
            address="id",
            by_hand=True,
        ),
    },
    "MethodsOfPro450": {
        "power_on": Call(
            "power_on", {"mode": "1"}, {"mode": ("mode", "1")}, gives="same", by_hand=True
        ),
    },
    "WaitingLonger": _waits("30"),
    "WaitingWithoutMode": _waits(mode=""),
    "WaitingInChain": _waits(mode="None"),
}
_HOMES = {
    "HomingAndWaiting": "move_angles([0] * {joints}, 30)",
    "HomingWithoutResult": "send_angles([0] * {joints}, 20)",
    **dict.fromkeys(["ByPort", "Reporting", "MethodsOfPro630", "MethodsOfPro450"], ""),
}
_HOME = "send_angles([0] * {joints}, 10)"


@lru_cache
def library() -> dict[str, LibraryClass]:
    """Return the classes of the library by name."""
    made: dict[str, LibraryClass] = {}
    for name in NAMES:
        given = class_row(name)
        made[name] = _class(given, made.get(given.get("like", "")))
    return made


@lru_cache
def counterparts() -> dict[str, str]:
    """Return, for each class of ours, the library's class with the rules for its calls."""
    return {kind.native: name for name, kind in library().items()} | {
        name: name for name, kind in library().items() if kind.native == name
    }


def are_alike(kinds: list[LibraryClass], method: str) -> bool:
    """Return whether a method is rewritten in the same way for all classes."""
    return all(
        (kinds[0].native, kinds[0].home, kinds[0].has(method), kinds[0].call(method))
        == (each.native, each.home, each.has(method), each.call(method))
        for each in kinds
    )


def _class(given: dict[str, Any], like: LibraryClass | None) -> LibraryClass:
    name: str = given["name"]
    helpers = [helper for _, helper in given.get("helpers", ())]
    calls = dict(like.methods if like else _SEVERAL)
    for helper in helpers:
        calls |= _OF_HELPERS.get(helper, {})
    calls |= {method.name: _call(method) for method in methods(given)}
    known = [each for each in helpers if each in _HOMES or each.startswith("Homing")]
    homes = (_HOMES.get(each, _HOME) for each in known)
    home = next(homes, like.home if like else _HOME).format(joints=given["joints"])
    return LibraryClass(
        name,
        given["opens"],
        tuple(parameter for parameter, *_ in given["constructor"]),
        given["native"],
        given.get("on_ports", ()),
        given["joints"],
        given.get("devices", {}),
        home,
        calls,
        {**(like.absent if like else absent("*")), **absent(name)},
    )


def _call(method: Method) -> Call:
    defaults = {name: "".join(map(repr, default)) for name, _, *default in method.parameters}
    return Call(
        method.calls,
        defaults,
        # Arguments of ours that the library's method lacks are left out.
        {ours: (given, "".join(default)) for ours, given, *default in method.arguments if given},
        method.result,
        method.gives,
        method.keywords,
        method.address,
    )
