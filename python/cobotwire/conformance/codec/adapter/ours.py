"""Our codecs as implementations of the line protocol."""

from __future__ import annotations

from cobotwire.codec.interface import Codec, Framer, Noise
from cobotwire.conformance.codec.named import encode_named, plain_fields
from cobotwire.conformance.codec.questions.question import Json
from cobotwire.protocol.errors import ProtocolError, UsageError

ABILITIES = [
    *(f"{do} {direction}" for do in ("encode", "decode") for direction in ("request", "reply")),
    *(f"stream {listening}" for listening in ("request", "reply", "both")),
    *("noise", "reasons"),
]


class OurCodec:
    """Answers questions with a codec; an ``Implementation`` in the same process."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec

    def ask(self, question: Json) -> Json:
        """Return the answer to one question."""
        does = {
            "hello": self._hello,
            "encode": self._encode,
            "decode": self._decode,
            "stream": self._stream,
        }
        return does[question["do"]](question)

    def _hello(self, question: Json) -> Json:
        return {
            "protocol": 1,
            "name": f"cobotwire {self._codec.name}",
            "edition": self._codec.table.edition,
            "can": ABILITIES,
        }

    def _encode(self, question: Json) -> Json:
        try:
            command, direction = question["command"], question["direction"]
            return {
                "bytes": encode_named(self._codec, command, direction, question["fields"]).hex()
            }
        except UsageError as error:
            return {"error": "bad-value", "why": str(error)}

    def _decode(self, question: Json) -> Json:
        data = bytes.fromhex(question["bytes"])
        try:
            message = self._codec.decode(question["direction"], data, of=question.get("command"))
        except ProtocolError as error:
            return {"error": error.reason, "offset": error.offset, "why": str(error)}
        return {"command": message.command.name, "fields": plain_fields(message)}

    def _stream(self, question: Json) -> Json:
        framer = self._codec.framer(question["direction"])
        return {"events": [events_of(framer, chunk) for chunk in question["chunks"]]}


def events_of(framer: Framer, chunk: str | None) -> list[Json]:
    """Return the events that a chunk, or a silence, makes certain."""
    events = framer.flush() if chunk is None else framer.feed(bytes.fromhex(chunk))
    return [
        {"noise": event.data.hex(), "offset": event.offset, "reason": event.reason}
        if isinstance(event, Noise)
        else {"frame": event.data.hex(), "offset": event.offset}
        for event in events
    ]
