"""The maker's library pymycobot, unmodified, behind the line protocol: MyCobot280 on our port.

It writes requests, and reads the reply to what it has just asked. It cuts no streams, reads no
requests and writes no replies. Where it would wait for more bytes, or ask again, it counts as
having refused what came.
"""

from __future__ import annotations

import contextlib
import struct
import sys
import threading
import warnings
from collections.abc import Iterable
from typing import Any

from cobotwire.conformance.codec.trials import Json
from cobotwire.conformance.codec.trials.pictures import named_values, plainest
from cobotwire.table import Command, Field, Layout, Table

# What it raises of arguments by accident. Its own checks raise classes of its own.
_BY_ACCIDENT = (struct.error, TypeError, ValueError, IndexError, KeyError, AttributeError)


class _Wrote(Exception):
    def __init__(self, data: bytes) -> None:
        self.data = data
        super().__init__(data.hex(" "))


class _Refused(Exception):
    """It would wait, or ask again."""


class _Port:
    """What it uses of ``serial.Serial``. Without an answer it throws what was written."""

    def __init__(self, answer: bytes | None) -> None:
        self._answer = answer
        self._waiting = b""
        self._asked = False

    def isOpen(self) -> bool:
        """It is."""
        return True

    def reset_input_buffer(self) -> None:
        """Throw away what was not read, as it asks for before each request."""
        self._waiting = b""

    def write(self, data: Any) -> None:
        """Take a request; the answer is there at once."""
        if self._answer is None:
            raise _Wrote(bytes(data))
        if self._asked:
            raise _Refused("it asks again")
        self._asked = True
        self._waiting += self._answer

    def inWaiting(self) -> int:
        """How many bytes of the answer are left."""
        return len(self._waiting)

    def read(self, size: int = 1) -> bytes:
        """The next bytes of the answer."""
        if not self._waiting:
            raise _Refused("it waits for more bytes")
        data, self._waiting = self._waiting[:size], self._waiting[size:]
        return data


class Pymycobot:
    """Answers questions with the library."""

    def __init__(self, table: Table) -> None:
        with warnings.catch_warnings():
            # Importing it calls what newer Pythons deprecate; that is not ours to mend.
            warnings.simplefilter("ignore")
            from pymycobot import MyCobot280

        self._kind = MyCobot280
        self._table = table

    def ask(self, question: Json) -> Json:
        """The answer to one question."""
        does = question["do"], question.get("direction")
        # It prints what it finds in some replies; the answers are ours alone.
        with contextlib.redirect_stdout(sys.stderr):
            if does == ("hello", None):
                return self._hello()
            if does == ("encode", "request"):
                return self._encode(question)
            if does == ("decode", "reply") and "command" in question:
                return self._decode(question)
        return {"unsupported": "pymycobot reads replies, and only those of what it has asked"}

    def _hello(self) -> Json:
        return {
            "protocol": 1,
            "name": "pymycobot MyCobot280",
            "edition": self._table.edition,
            "can": ["encode request", "decode reply"],
        }

    def _peer(self, answer: bytes | None) -> Any:
        """Its class as its constructor makes it, but for the port and 1.5 s of sleep."""
        peer = object.__new__(self._kind)
        module = sys.modules[self._kind.__module__]
        module.CommandGenerator.__init__(peer)
        peer.calibration_parameters = module.calibration_parameters
        peer.lock = threading.Lock()
        peer.thread_lock = True
        peer._serial_port = _Port(answer)
        return peer

    def _encode(self, question: Json) -> Json:
        command = self._table.command(question["command"])
        call = getattr(self._peer(None), command.name, None)
        if call is None:
            return {"unsupported": f"pymycobot has no {command.name}"}
        try:
            _without_output(call, _arguments(command, question["fields"]))
        except _Wrote as wrote:
            return {"bytes": wrote.data.hex()}
        return {"error": "nothing was written"}

    def _decode(self, question: Json) -> Json:
        command = self._table.command(question["command"])
        data = bytes.fromhex(question["bytes"])
        call = getattr(self._peer(data), command.name, None)
        if call is None:
            return {"unsupported": f"pymycobot has no {command.name}"}
        asked = min(command.request, key=lambda form: form.size)
        arguments = _arguments(command, named_values(asked, plainest(asked)))
        result = _without_output(call, arguments)
        if result is None or result == -1:
            return {"error": f"it gives {result}"}
        size = len(data) - self._table.frame.overhead - 1 - self._table.frame.check_size
        layouts = [form for form in command.reply if form.size == size] or list(command.reply)
        return {"command": command.name, "fields": _by_name(layouts[0], result)}


def _without_output(call: Any, arguments: list[Any]) -> Any:
    """Call it. What it raises of arguments or bytes is a refusal; -1 stands for it here."""
    try:
        return call(*arguments)
    except _Wrote:
        raise
    except (_Refused, *_BY_ACCIDENT):
        return -1
    except Exception as error:
        if type(error).__module__.startswith("pymycobot"):
            return -1
        raise


def _arguments(command: Command, fields: Json) -> list[Any]:
    """Values as its callers give them: in order, lists, and whole numbers where they are whole."""
    form = next(
        form for form in command.request if {field.name for field in form.fields} == set(fields)
    )
    framed = [_plain(fields[field.name]) for field in form.fields if not _is_constant(field)]
    text = command.request_text
    return framed + ([] if text is None else [""] * len(text.fields))


def _is_constant(field: Field) -> bool:
    """Whether it can hold one number alone, and so is no argument of the library's method."""
    number = field.cases[0].numbers[0]
    return number.minimum == number.maximum or len(field.choices) == 1


def _plain(value: Any) -> Any:
    if isinstance(value, list):
        return [_plain(part) for part in value]
    return int(value) if isinstance(value, float) and value.is_integer() else value


def _by_name(layout: Layout, result: Any) -> Json:
    """What it gives, by our names; what it took for an echo it does not tell."""
    fields = [field for field in layout.fields if not field.echo]
    if len(fields) == 1:
        return {fields[0].name: [result] if fields[0].many and _alone(result) else result}
    flat = list(result) if isinstance(result, Iterable) else [result]
    named: Json = {}
    for field in fields:
        count = len(field.cases[0].numbers)
        part, flat = flat[:count], flat[count:]
        named[field.name] = part if field.many else next(iter(part), None)
    return named


def _alone(result: Any) -> bool:
    return not isinstance(result, list | tuple)
