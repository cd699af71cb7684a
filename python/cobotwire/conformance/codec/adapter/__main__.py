"""``python -m cobotwire.conformance.codec.adapter NAME``: answer questions on standard output."""

from __future__ import annotations

import json
import sys

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.conformance.codec.adapter.pymycobot import Pymycobot
from cobotwire.conformance.codec.implementation import Implementation
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.protocol.errors import CobotwireError, UsageError


def codec_of(name: str, edition: str) -> Implementation:
    """Return the codec that is called ``name`` on the command line, for an edition.

    Raises:
        UsageError: there is no such codec or edition.
    """
    table = editions.load(edition).TABLE
    if name == "pymycobot":
        return Pymycobot(table)
    if name not in ("native", "reference"):
        raise UsageError("adapter", name, "native, reference or pymycobot")
    return OurCodec(codecs.load(table, "native" if name == "native" else "reference"))


def main() -> None:
    """Answer each question; the first, ``hello``, names the edition."""
    codec: Implementation | None = None
    for line in sys.stdin:
        question = json.loads(line)
        try:
            if question["do"] == "hello":
                codec = codec_of("".join(sys.argv[1:]), question["edition"])
            if codec is None:
                raise UsageError("do", message=f"the first question is {question['do']}, not hello")
            answer = codec.ask(question)
        except CobotwireError as error:
            answer = {"error": str(error)}
        sys.stdout.write(json.dumps({"id": question["id"], **answer}) + "\n")
        sys.stdout.flush()


main()
