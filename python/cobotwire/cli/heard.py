"""What a simulated arm hears and answers, on a line: for people, or as JSON."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any, NamedTuple

from cobotwire.cli.call import plain
from cobotwire.codec.interface import Noise
from cobotwire.explain import summary
from cobotwire.session.device import Asked, DeviceEvent, Malformed
from cobotwire.sim.faults import Done


class Shown(NamedTuple):
    """How it is shown; ``client`` is its number, None where there is only one."""

    serving: Callable[[str], str]
    event: Callable[[int | None, DeviceEvent, bytes], str]
    fault: Callable[[int | None, Done], str]


def _line(client: int | None, said: str) -> str:
    return said if client is None else f"{client:>3} {said}"


def _in_words(event: DeviceEvent, answer: bytes) -> str:
    said = f"   answered {_hex(answer)}" if answer else ""
    if isinstance(event, Noise):
        return f"noise   {_hex(event.data)}   {event.reason}"
    if isinstance(event, Asked):
        return f"heard   {_hex(event.frame.data)}   {summary(event.message)}{said}"
    if isinstance(event, Malformed):
        return f"refused {_hex(event.frame.data)}   {event.error}"
    fields = ", ".join(f"{name}={value!r}" for name, value in event.fields.items())
    return f"text    of {event.command.name}: {fields}"


def _object(client: int | None, said: dict[str, Any]) -> str:
    return json.dumps(said if client is None else {"client": client, **said})


def _as_object(event: DeviceEvent, answer: bytes) -> dict[str, Any]:
    said = {"answer": _hex(answer)} if answer else {}
    if isinstance(event, Noise):
        return {"event": "noise", "data": _hex(event.data), "reason": event.reason}
    if isinstance(event, Asked):
        fields = {name: plain(value) for name, value in event.message.fields.items()}
        asked = {"command": event.message.command.name, "fields": fields}
        return {"event": "heard", "data": _hex(event.frame.data), **asked, **said}
    if isinstance(event, Malformed):
        return {"event": "refused", "data": _hex(event.frame.data), "error": str(event.error)}
    return {"event": "text", "command": event.command.name, "fields": event.fields}


def _hex(data: bytes) -> str:
    return data.hex(" ").upper()


SHOWN = {
    "words": Shown(
        serving=lambda url: url,
        event=lambda client, event, answer: _line(client, _in_words(event, answer)),
        fault=lambda client, done: _line(client, f"fault   {done}"),
    ),
    "json": Shown(
        serving=lambda url: _object(None, {"event": "serving", "url": url}),
        event=lambda client, event, answer: _object(client, _as_object(event, answer)),
        fault=lambda client, done: _object(client, {"event": "fault", **done._asdict()}),
    ),
}
