"""Define messages as typed objects: one class for each command's request, and one for its reply.

The generator writes these classes into an edition's ``messages.py``. For a table without a
generated package, :mod:`cobotwire.protocol.made_messages` makes them from the table's records.

A subclass names its fields by annotations, from which type checkers derive its constructor::

    class GetEncoder(Request[int], command="get_encoder"):
        joint: int

    class GetEncoderReply(Reply[int], to=GetEncoder):
        encoder: int

Every client loads two hundred of these classes, so creating one must take only microseconds. For
this reason neither ``dataclasses`` nor the run-time part of ``typing.Generic`` is used.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import (
    TYPE_CHECKING,
    Any,
    ClassVar,
    Generic,
    NoReturn,
    Self,
    TypeVar,
    dataclass_transform,
)

from cobotwire.protocol.arguments import Chosen, Row, arranged, choose
from cobotwire.protocol.converters import converters_of
from cobotwire.protocol.radians import to_degrees

Result = TypeVar("Result", covariant=True)


@dataclass_transform(frozen_default=True)
class Message:
    """A request or a reply, with its fields as attributes.

    Messages are immutable. Two messages are equal if their types and fields are equal. A field that
    this variant of the message leaves out is None.
    """

    command: ClassVar[str] = ""
    """The name of the command."""
    fieldless: ClassVar[bool] = False
    """Whether all its messages are equal: it has no fields, and no constants on the wire."""

    _names: ClassVar[tuple[str, ...]] = ()
    # Names and constants in wire order; empty if that is the order of declaration.
    _wire: ClassVar[Row] = ()
    # The variants, if the given arguments choose one of several; and the choices made so far.
    _variants: ClassVar[tuple[Row, ...]] = ()
    _choices: ClassVar[dict[tuple[str, ...], Chosen]]
    _radians: ClassVar[frozenset[str]] = frozenset()
    _text: ClassVar[tuple[str, ...]] = ()
    # Fields that hold several numbers.
    _rows: ClassVar[tuple[str, ...]] = ()
    # Whether the attributes, in their order, are the values of the frame.
    _direct: ClassVar[bool] = True
    _converters: ClassVar[Mapping[str, Callable[[Any], Any]] | None] = None

    @classmethod
    def _declare(
        cls,
        wire: Row = (),
        radians: tuple[str, ...] = (),
        text: tuple[str, ...] = (),
        variants: tuple[Row, ...] = (),
    ) -> None:
        """Record the fields of a class, and their order on the wire.

        Args:
            wire: field names and constants in wire order, if it is not the order of declaration.
            radians: fields in radians, which the wire carries in degrees.
            text: fields of text outside the frame.
            variants: the variants in the order of the table, each in wire order, if they differ in
                more than optional fields at the end.
        """
        annotations = cls.__annotations__
        names = tuple(annotations)
        cls._names = names
        # Type checkers derive it from the annotations, and forbid setting it.
        type.__setattr__(cls, "__match_args__", names)
        cls._rows = tuple([name for name in names if annotations[name].startswith("Sequence")])
        cls.fieldless = not names and not wire
        if not names:
            # The class takes no arguments, so a faster constructor is enough: clients make a
            # request for each call.
            type.__setattr__(cls, "__init__", object.__init__)
        if wire or radians or text or variants or (names and names[-1] in cls.__dict__):
            cls._direct = False
            cls._variants = variants
            cls._choices = {}
            cls._wire = wire or tuple([name for name in names if name not in text])
            cls._radians = frozenset(radians)
            cls._text = text

    if not TYPE_CHECKING:

        def __init__(self, *arguments: Any, **named: Any) -> None:
            names = self._names
            if named or len(arguments) != len(names):
                arguments = arranged(type(self), names, arguments, named)
            fields = self.__dict__
            fields.update(zip(names, arguments))
            for name in self._rows:
                # A list can change later, and has no hash.
                if type(fields[name]) is list:
                    fields[name] = tuple(fields[name])
            if self._variants:
                fields.update(self._chosen().defaults)

        def __setattr__(self, name: str, value: object) -> NoReturn:
            raise AttributeError(f"{type(self).__name__} is immutable; {name} cannot be set")

        def __delattr__(self, name: str) -> NoReturn:
            raise AttributeError(f"{type(self).__name__} is immutable; {name} cannot be deleted")

        def __class_getitem__(cls, result: object) -> type:
            # Only type checkers need the result's type.
            return cls

    @classmethod
    def _of(cls, *arguments: Any) -> Self:
        """Return the message with these arguments by position; None leaves an argument out."""
        return cls(*arguments)

    @classmethod
    def from_fields(cls, fields: Mapping[str, Any]) -> Self:
        """Return the message with these fields, which the codec has decoded.

        Numbers become enum members, rows become named tuples, and degrees become radians, as the
        class declares. Names that the class does not have are ignored.
        """
        converters = cls._converters or cls._make_converters()
        message = cls.__new__(cls)
        own = message.__dict__
        for name in cls._names:
            value = fields.get(name)
            if value is not None and name in converters:
                value = converters[name](value)
            own[name] = value
        return message

    @classmethod
    def _make_converters(cls) -> Mapping[str, Callable[[Any], Any]]:
        """Return the functions that convert decoded values, by field; they are made once."""
        if cls._converters is None:
            cls._converters = converters_of(cls, cls._names, cls._radians)
        return cls._converters

    @property
    def fields(self) -> dict[str, Any]:
        """The fields by name, as the codec encodes them, without those that are None."""
        fields = {name: value for name, value in self.__dict__.items() if value is not None}
        for name in self._radians & fields.keys():
            fields[name] = to_degrees(fields[name])
        return fields

    @classmethod
    def fields_in_radians(cls) -> frozenset[str]:
        """Return the names of the fields in radians; the wire carries them in degrees."""
        return cls._radians

    @property
    def values(self) -> tuple[Any, ...]:
        """The values of the frame in the order of the wire, as ``codec.encode`` takes them."""
        raise NotImplementedError

    def _wire_values(self) -> list[Any]:
        own, radians = self.__dict__, self._radians
        return [
            part
            if type(part) is not str
            else to_degrees(own[part])
            if part in radians
            else own[part]
            for part in (self._chosen().wire if self._variants else self._wire)
        ]

    def _chosen(self) -> Chosen:
        """Return the variant that takes the arguments which are not None.

        Raises:
            TypeError: no variant takes exactly these arguments.
        """
        own = self.__dict__
        given = tuple([n for n in self._names if own[n] is not None and n not in self._text])
        found = self._choices.get(given)
        if found is None:
            found = self._choices[given] = choose(type(self).__name__, self._variants, given)
        return found

    @property
    def text_values(self) -> dict[str, str]:
        """The fields of text outside the frame, by name."""
        return {name: self.__dict__[name] for name in self._text}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Message) or type(self) is not type(other):
            return NotImplemented
        return self.__dict__ == other.__dict__

    def __hash__(self) -> int:
        return hash((type(self), *self.__dict__.values()))

    def __repr__(self) -> str:
        shown = (f"{name}={value!r}" for name, value in self.__dict__.items() if value is not None)
        return f"{type(self).__name__}({', '.join(shown)})"


class Request(Message, Generic[Result]):
    """A message to the arm; ``Result`` is the type that the client's method returns."""

    reply_type: ClassVar[type[Reply[Any]] | None] = None
    """The class of the reply; None for a one-way request."""

    def __init_subclass__(cls, *, command: str, **layout: Any) -> None:
        """Record the command's name; pass ``layout`` to :meth:`_declare`."""
        cls._declare(**layout)
        cls.command = command

    def result_of(self, fields: Mapping[str, Any]) -> Result:
        """Return what a client's method returns, given the decoded fields of the reply."""
        reply = self.reply_type
        assert reply is not None, "a request that is waited for has a reply"
        single = reply._single
        if single is None:
            return reply.result_from(fields)  # type: ignore[no-any-return]
        # As `result_from` does, without the call.
        name, convert = single
        value: Any = fields.get(name)
        found: Result = value if value is None or convert is None else convert(value)
        return found

    @property
    def variant_index(self) -> int | None:
        """The index of the variant that the arguments choose; None: their number decides."""
        return self._chosen().variant if self._variants else None

    @property
    def values(self) -> tuple[Any, ...]:
        """The values of the frame in the order of the wire, as ``codec.encode`` takes them.

        Optional arguments at the end that are None are left out; the codec rejects any other None.
        """
        if self._direct:
            return tuple(self.__dict__.values())
        values = self._wire_values()
        while values and values[-1] is None:
            values.pop()
        return tuple(values)


class Reply(Message, Generic[Result]):
    """A message from the arm. Required fields come first; optional fields may be None."""

    request_type: ClassVar[type[Request[Any]]]
    """The class of the request."""
    _results: ClassVar[tuple[str, ...]] = ()
    _result_type: ClassVar[Callable[..., Any] | None] = None
    # The field that is the only result, and what converts it; known after the first result.
    _single: ClassVar[tuple[str, Callable[[Any], Any] | None] | None] = None

    def __init_subclass__(
        cls,
        *,
        to: type[Request[Any]] | None = None,
        result: Callable[..., Any] | None = None,
        results: tuple[str, ...] | None = None,
        **layout: Any,
    ) -> None:
        """Record the request's class, and what every message declares.

        Args:
            to: the class of the request; None: the class is no message itself, like :class:`Event`.
            result: the named tuple of the results, if there are several.
            results: the fields that are results; None: those that every variant has.
            layout: arguments for :meth:`_declare`.
        """
        if to is None:
            return
        cls._declare(**layout)
        cls.command = to.command
        cls.request_type = to
        if results is None:
            results = tuple([name for name in cls._names if name not in cls.__dict__])
        cls._results = results
        cls._result_type = result
        to.reply_type = cls

    @property
    def result(self) -> Result:
        """The value that the client's method returns."""
        own, names, result_type = self.__dict__, self._results, self._result_type
        found: Any = None
        if result_type is not None:
            found = result_type(*[own[name] for name in names])
        elif names:
            found = own[names[0]]
        return found  # type: ignore[no-any-return]  # Result is the annotation of these fields

    @classmethod
    def result_from(cls, fields: Mapping[str, Any]) -> Any:
        """Return the ``result`` of the reply with these fields, which the codec has decoded.

        Most replies have one result, and no client needs the reply itself.
        """
        if cls._result_type is not None or not cls._results:
            return cls.from_fields(fields).result
        if cls._single is None:
            name = cls._results[0]
            cls._single = name, cls._make_converters().get(name)
        name, convert = cls._single
        value = fields.get(name)
        return value if value is None or convert is None else convert(value)

    @property
    def values(self) -> tuple[Any, ...]:
        """The values of the frame in the order of the wire, without fields that are None."""
        if self._direct:
            return tuple(self.__dict__.values())
        return tuple([value for value in self._wire_values() if value is not None])


class Event(Reply[Any]):
    """A message that the device sends without a request."""

    def __init_subclass__(cls, *, event: str, **layout: Any) -> None:
        """Record the name of the event; pass ``layout`` to :meth:`_declare`."""
        cls._declare(**layout)
        cls.command = event
        cls._results = tuple([name for name in cls._names if name not in cls.__dict__])
