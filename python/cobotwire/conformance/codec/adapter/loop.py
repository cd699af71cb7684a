"""The loop of an implementation: read a question from each line, write an answer to each."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import IO

from cobotwire.conformance.codec.questions.question import Json
from cobotwire.protocol.errors import CobotwireError

Answer = Callable[[Json], Json]


def serve(answer: Answer, questions: IO[str], answers: IO[str]) -> None:
    """Answer until the questions end."""
    for line in questions:
        question = json.loads(line)
        try:
            result = answer(question)
        except CobotwireError as error:
            result = {"error": str(error)}
        answers.write(json.dumps({"id": question["id"], **result}) + "\n")
        answers.flush()
