"""``python -m cobotwire.conformance.codec.adapter NAME``: answer questions on standard output."""

from __future__ import annotations

import sys

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.conformance.codec.adapter.loop import Answer, serve
from cobotwire.conformance.codec.adapter.pymycobot import Pymycobot
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.conformance.codec.questions.question import Json
from cobotwire.protocol.errors import UsageError


class Adapter:
    """Creates the codec of the edition that the greeting names."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._answer: Answer | None = None

    def ask(self, question: Json) -> Json:
        """Return the answer to one question; the first question names the edition."""
        if question["do"] == "hello":
            self._answer = self._of_edition(question["edition"])
        if self._answer is None:
            raise UsageError("do", message=f"the first question is {question['do']}, not hello")
        return self._answer(question)

    def _of_edition(self, edition: str) -> Answer:
        table = editions.load(edition).TABLE
        if self._name == "pymycobot":
            return Pymycobot(table).ask
        if self._name not in ("native", "reference"):
            raise UsageError("adapter", self._name, "native, reference or pymycobot")
        name: codecs.CodecName = "native" if self._name == "native" else "reference"
        return OurCodec(codecs.load(table, name)).ask


def main() -> None:
    """Answer until the questions end."""
    serve(Adapter("".join(sys.argv[1:])).ask, sys.stdin, sys.stdout)


main()
