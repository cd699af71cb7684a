"""``python -m cobotwire.conformance.codec.adapter NAME``: answers on standard output."""

from __future__ import annotations

import sys

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.conformance.codec.adapter.loop import Answer, serve
from cobotwire.conformance.codec.adapter.ours import OurCodec
from cobotwire.conformance.codec.trials import Json
from cobotwire.errors import UsageError


class Adapter:
    """Makes the codec that the greeting asks for."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._answer: Answer | None = None

    def ask(self, question: Json) -> Json:
        """The answer to one question; the first one names the edition."""
        if question["do"] == "hello":
            self._answer = self._of_edition(question["edition"])
        if self._answer is None:
            raise UsageError("do", question["do"], "hello first")
        return self._answer(question)

    def _of_edition(self, edition: str) -> Answer:
        table = editions.load(edition).TABLE
        if self._name == "pymycobot":
            from cobotwire.conformance.codec.adapter.pymycobot import Pymycobot

            return Pymycobot(table).ask
        if self._name not in ("native", "reference"):
            raise UsageError("adapter", self._name, "native, reference or pymycobot")
        name: codecs.CodecName = "native" if self._name == "native" else "reference"
        return OurCodec(codecs.load(table, name)).ask


def main() -> None:
    """Serve until the questions end."""
    serve(Adapter("".join(sys.argv[1:])).ask, sys.stdin, sys.stdout)


main()
