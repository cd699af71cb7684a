"""Define frozen classes of fields, as ``dataclass(frozen=True, slots=True)`` does, but quickly.

``dataclasses`` generates code for each class, and needs ``inspect``: for the classes of a client
that took a third of the time of opening it. Here all classes share their methods. For type checkers
a ``record`` is a dataclass. For programs too: ``fields``, ``replace`` and ``asdict`` of
``dataclasses`` take it, and its parameters and fields are made when they are first read.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

__all__ = ["field", "record"]

_MISSING: Any = object()


class _Field(NamedTuple):
    """A field; the names are those of ``dataclasses.field``."""

    default: Any = _MISSING
    default_factory: Any = _MISSING
    init: bool = True
    repr: bool = True
    compare: bool = True
    kw_only: bool = False


if TYPE_CHECKING:
    from dataclasses import dataclass as record
    from dataclasses import field
else:

    def field(**options: Any) -> Any:
        """Return what a class assigns to a field that needs more than a default."""
        return _Field(**options)

    def record(*, frozen: bool, slots: bool, kw_only: bool = False) -> Callable[[type], type]:
        """Return a decorator that makes a class a frozen record with slots."""
        assert (frozen, slots) == (True, True), "there are no others"
        return lambda cls: _made(cls, kw_only)


def _made(cls: type, kw_only: bool) -> type:
    """Return the class with slots; like ``dataclasses``, this makes another class."""
    fields: dict[str, _Field] = dict(getattr(cls, "_record_fields", {}))
    inherited = set(fields)
    members = dict(cls.__dict__)
    for name, annotation in members.get("__annotations__", {}).items():
        if not annotation.startswith("ClassVar"):
            default = members.pop(name, _MISSING)
            if not isinstance(default, _Field):
                default = _Field(default)
            fields[name] = default._replace(kw_only=kw_only)
    for name in ("__dict__", "__weakref__"):
        members.pop(name, None)
    given = {name: each for name, each in fields.items() if each.init}
    compared = tuple([name for name, each in fields.items() if each.compare])
    members |= {
        "__slots__": tuple([name for name in fields if name not in inherited]),
        "__match_args__": tuple([name for name, each in given.items() if not each.kw_only]),
        "__qualname__": cls.__qualname__,
        "_record_fields": fields,
        "_record_given": given,
        "_record_compared": attrgetter(*compared) if compared else lambda _: (),
        "__dataclass_fields__": _Later("__dataclass_fields__"),
        "__dataclass_params__": _Later("__dataclass_params__"),
        "__signature__": _Later("__signature__"),
        "__setattr__": _refuse_to_set,
        "__delattr__": _refuse_to_delete,
        "__getstate__": _state,
        "__setstate__": _set_state,
    }
    for name, method in (("__eq__", _equal), ("__hash__", _hash), ("__repr__", _shown)):
        members.setdefault(name, method)
    made: Any = type(cls)(cls.__name__, cls.__bases__, members)
    made.__init__ = _initialiser(made, given, fields)
    return made  # type: ignore[no-any-return]


def _initialiser(made: Any, given: Mapping[str, _Field], fields: Mapping[str, _Field]) -> Any:
    """Return the constructor of a class."""
    setters = tuple([getattr(made, name).__set__ for name in given])
    defaults = tuple([each.default for each in given.values()])
    pairs = tuple(zip(given, defaults))
    # Fields with a default follow them, or are passed by name.
    required = frozenset([name for name, each in given.items() if each.default is _MISSING])
    names: tuple[str, ...] = made.__match_args__
    all_given, positional = len(given), len(names)
    lists = [
        (getattr(made, name).__set__, each.default_factory)
        for name, each in fields.items()
        if each.default_factory is not _MISSING
    ]
    finish = getattr(made, "__post_init__", None)

    def __init__(self: Any, *arguments: Any, **named: Any) -> None:
        count = len(arguments)
        values: Sequence[Any] = arguments
        if named or count > positional:
            given = {**dict(zip(names, arguments)), **named}
            if len(given) != count + len(named) or not required <= given.keys():
                raise _misfit(made, arguments, named)
            values = [given.pop(name, default) for name, default in pairs]
            if given:
                raise _misfit(made, arguments, named)
        elif count < all_given:
            if count < len(required):
                raise _misfit(made, arguments, named)
            values = arguments + defaults[count:]
        for set_field, value in zip(setters, values):
            set_field(self, value)
        for set_field, make in lists:
            set_field(self, make())
        if finish is not None:
            finish(self)

    __init__.__qualname__ = f"{made.__qualname__}.__init__"
    return __init__


def _misfit(made: Any, arguments: Sequence[Any], named: Mapping[str, Any]) -> TypeError:
    """Return the error for arguments of which one is missing, unknown, or given twice."""
    call, positional = f"{made.__qualname__}.__init__()", made.__match_args__
    if len(arguments) > len(positional):
        given = f"takes {len(positional)} positional arguments but {len(arguments)} were given"
        return TypeError(f"{call} {given}")
    known = made._record_given
    for name in named:
        if name not in known:
            return TypeError(f"{call} got an unexpected keyword argument {name!r}")
        if name in positional[: len(arguments)]:
            return TypeError(f"{call} got multiple values for argument {name!r}")
    there = {*positional[: len(arguments)], *named}
    missing = [name for name, each in known.items() if each.default is _MISSING]
    names = ", ".join([repr(name) for name in missing if name not in there])
    return TypeError(f"{call} is missing its argument {names}")


def _equal(self: Any, other: Any) -> Any:
    if other.__class__ is not self.__class__:
        return NotImplemented
    compared = self._record_compared
    return compared(self) == compared(other)


def _hash(self: Any) -> int:
    return hash(type(self)._record_compared(self))


def _shown(self: Any) -> str:
    shown = [f"{n}={getattr(self, n)!r}" for n, each in self._record_fields.items() if each.repr]
    return f"{type(self).__qualname__}({', '.join(shown)})"


def _refuse_to_set(self: Any, name: str, value: object) -> NoReturn:
    from dataclasses import FrozenInstanceError

    raise FrozenInstanceError(f"cannot assign to field {name!r}")


def _refuse_to_delete(self: Any, name: str) -> NoReturn:
    from dataclasses import FrozenInstanceError

    raise FrozenInstanceError(f"cannot delete field {name!r}")


def _state(self: Any) -> list[Any]:
    return [getattr(self, name) for name in self._record_fields]


def _set_state(self: Any, state: list[Any]) -> None:
    for name, value in zip(self._record_fields, state):
        object.__setattr__(self, name, value)
    finish = getattr(self, "__post_init__", None)
    if finish is not None:
        finish()


class _Later:
    """An attribute of the dataclass that a record stands for; it is made on first use."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, instance: object, owner: type) -> Any:
        from inspect import signature

        twin = _twin(owner)
        found = signature(twin) if self._name == "__signature__" else getattr(twin, self._name)
        setattr(owner, self._name, found)
        return found


def _twin(owner: Any) -> type:
    """Return a dataclass with the fields of a record."""
    import dataclasses

    made = []
    for name, each in owner._record_fields.items():
        options = {key: value for key, value in each._asdict().items() if value is not _MISSING}
        made.append((name, _annotation(owner, name), dataclasses.field(**options)))
    return dataclasses.make_dataclass(owner.__name__, made, frozen=True)


def _annotation(owner: type, name: str) -> str:
    annotations = [vars(each).get("__annotations__", {}) for each in owner.__mro__]
    return next(str(found[name]) for found in annotations if name in found)
