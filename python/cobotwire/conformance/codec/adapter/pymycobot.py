"""The maker's library pymycobot, unmodified, as a codec under test: MyCobot280 on our port.

It encodes requests, and decodes the reply to the request that it has just sent. It frames no
streams, decodes no requests and encodes no replies. If it waits for more bytes, or sends a request
again, it has rejected the bytes.
"""

from __future__ import annotations

import contextlib
import struct
import sys
import threading
import warnings
from collections.abc import Iterable
from typing import Any

from cobotwire.conformance.codec.questions.question import Json
from cobotwire.conformance.samples.physical import named_values
from cobotwire.conformance.samples.raw import plainest
from cobotwire.protocol.table import Command, Field, Table, Variant

# Exceptions that the library raises by accident; its checks raise classes of its own.
_BY_ACCIDENT = (struct.error, TypeError, ValueError, IndexError, KeyError, AttributeError)


class _Wrote(Exception):
    def __init__(self, data: bytes) -> None:
        self.data = data
        super().__init__(data.hex(" "))


class _Rejected(Exception):
    """The library waits for more bytes, or sends the request again."""


class _Port:
    """The part of ``serial.Serial`` that the library uses.

    If there is no reply to give, ``write`` raises :class:`_Wrote` with the bytes.
    """

    def __init__(self, reply: bytes | None) -> None:
        self._reply = reply
        self._waiting = b""
        self._sent = False

    def isOpen(self) -> bool:
        """Return True."""
        return True

    def reset_input_buffer(self) -> None:
        """Discard unread bytes; the library calls this before each request."""
        self._waiting = b""

    def write(self, data: Any) -> None:
        """Take a request; the reply is available at once."""
        if self._reply is None:
            raise _Wrote(bytes(data))
        if self._sent:
            raise _Rejected("it sends the request again")
        self._sent = True
        self._waiting += self._reply

    def inWaiting(self) -> int:
        """Return how many bytes of the reply are left."""
        return len(self._waiting)

    def read(self, size: int = 1) -> bytes:
        """Return the next bytes of the reply."""
        if not self._waiting:
            raise _Rejected("it waits for more bytes")
        data, self._waiting = self._waiting[:size], self._waiting[size:]
        return data


class Pymycobot:
    """Answers questions with the library."""

    def __init__(self, table: Table) -> None:
        with warnings.catch_warnings():
            # pymycobot uses functions that newer Pythons deprecate.
            warnings.simplefilter("ignore")
            from pymycobot import MyCobot280

        self._kind = MyCobot280
        self._table = table

    def ask(self, question: Json) -> Json:
        """Return the answer to one question."""
        does = question["do"], question.get("direction")
        # pymycobot prints while it decodes some replies, but standard output is only for answers.
        with contextlib.redirect_stdout(sys.stderr):
            if does == ("hello", None):
                return self._hello()
            if does == ("encode", "request"):
                return self._encode(question)
            if does == ("decode", "reply") and "command" in question:
                return self._decode(question)
        return {"unsupported": "pymycobot decodes only replies to its own requests"}

    def _hello(self) -> Json:
        return {
            "protocol": 1,
            "name": "pymycobot MyCobot280",
            "edition": self._table.edition,
            "can": ["encode request", "decode reply"],
        }

    def _peer(self, reply: bytes | None) -> Any:
        """Return an instance of the library's class without opening a port or sleeping 1.5 s."""
        peer = object.__new__(self._kind)
        module = sys.modules[self._kind.__module__]
        module.CommandGenerator.__init__(peer)
        peer.calibration_parameters = module.calibration_parameters
        peer.lock = threading.Lock()
        peer.thread_lock = True
        peer._serial_port = _Port(reply)
        return peer

    def _encode(self, question: Json) -> Json:
        command = self._table.command(question["command"])
        call = getattr(self._peer(None), command.name, None)
        if call is None:
            return {"unsupported": f"pymycobot has no {command.name}"}
        try:
            _call(call, _arguments(command, question["fields"]))
        except _Wrote as wrote:
            return {"bytes": wrote.data.hex()}
        return {"error": "nothing was written"}

    def _decode(self, question: Json) -> Json:
        command = self._table.command(question["command"])
        data = bytes.fromhex(question["bytes"])
        call = getattr(self._peer(data), command.name, None)
        if call is None:
            return {"unsupported": f"pymycobot has no {command.name}"}
        shortest = min(command.request, key=lambda variant: variant.size)
        arguments = _arguments(command, named_values(shortest, plainest(shortest)))
        result = _call(call, arguments)
        if result is None or result == -1:
            return {"error": f"it returns {result}"}
        size = len(self._table.frame.data(data, "reply"))
        variants = [variant for variant in command.reply if variant.size == size] or list(
            command.reply
        )
        return {"command": command.name, "fields": _by_name(variants[0], result)}


def _call(call: Any, arguments: list[Any]) -> Any:
    """Call a method; return -1 if it rejects the arguments or the bytes."""
    try:
        return call(*arguments)
    except _Wrote:
        raise
    except (_Rejected, *_BY_ACCIDENT):
        return -1
    except Exception as error:
        if type(error).__module__.startswith("pymycobot"):
            return -1
        raise


def _arguments(command: Command, fields: Json) -> list[Any]:
    """Return values as callers of the library pass them: in order, integers where possible."""
    variant = next(
        variant
        for variant in command.request
        if {field.name for field in variant.fields} == set(fields)
    )
    framed = [_plain(fields[field.name]) for field in variant.fields if not _is_constant(field)]
    text = command.request_text
    return framed + ([] if text is None else [""] * len(text.fields))


def _is_constant(field: Field) -> bool:
    """Return whether a field has only one legal value; the method then has no argument for it."""
    number = field.cases[0].numbers[0]
    return number.minimum == number.maximum or len(field.choices) == 1


def _plain(value: Any) -> Any:
    if isinstance(value, list):
        return [_plain(part) for part in value]
    return int(value) if isinstance(value, float) and value.is_integer() else value


def _by_name(variant: Variant, result: Any) -> Json:
    """Return the library's result by our field names; it returns no echoes."""
    fields = [field for field in variant.fields if not field.echo]
    if len(fields) == 1:
        return {fields[0].name: [result] if fields[0].many and _is_single(result) else result}
    flat = list(result) if isinstance(result, Iterable) else [result]
    named: Json = {}
    for field in fields:
        count = len(field.cases[0].numbers)
        part, flat = flat[:count], flat[count:]
        named[field.name] = part if field.many else next(iter(part), None)
    return named


def _is_single(result: Any) -> bool:
    return not isinstance(result, list | tuple)
