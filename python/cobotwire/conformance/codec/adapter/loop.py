"""The line protocol as an implementation sees it: a question a line in, an answer a line out."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import IO

from cobotwire.conformance.codec.trials import Json
from cobotwire.errors import CobotwireError

Answer = Callable[[Json], Json]


def serve(answer: Answer, questions: IO[str], answers: IO[str]) -> None:
    """Answer until the questions end."""
    for line in questions:
        question = json.loads(line)
        try:
            said = answer(question)
        except CobotwireError as error:
            said = {"error": str(error)}
        answers.write(json.dumps({"id": question["id"], **said}) + "\n")
        answers.flush()
