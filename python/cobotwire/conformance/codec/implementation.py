"""The codec under test, which answers questions in this process or another one."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import tempfile
import time
from collections.abc import Sequence
from types import TracebackType
from typing import Any, Protocol, Self

from cobotwire.conformance import programs
from cobotwire.conformance.codec.questions.question import Json
from cobotwire.conformance.device.program_transport import DescriptorEnd
from cobotwire.protocol.errors import CobotwireError, LinkError

# A longer line is not an answer: real answers need less than a hundredth of it.
LONGEST_LINE = 1 << 20
# An answer nests four levels; json itself fails at about a thousand.
DEEPEST = 16
# The greeting may take this many times as long as an answer, because the command has to start.
STARTING = 3


class NoAnswer(CobotwireError):
    """The implementation crashed or ended, is silent, or does not speak the protocol.

    Attributes:
        kind: ``crashed``, ``ended`` (without an error), ``silent`` or ``malformed``.
    """

    def __init__(self, kind: str, detail: str) -> None:
        self.kind = kind
        super().__init__(f"{kind}: {detail}")


class Implementation(Protocol):
    """A codec that answers the questions of the line protocol."""

    def ask(self, question: Json) -> Json:
        """Return the answer to a question.

        Raises:
            NoAnswer: no valid answer came. The next question restarts the implementation.
        """
        ...


class Program:
    """A command that speaks the line protocol on its standard input and output.

    The first question starts it. If it crashes or hangs, the next question starts it again.
    """

    def __init__(self, command: Sequence[str], *, timeout: float = 10.0) -> None:
        """Set the command, and the seconds that it has for each answer; the greeting has more."""
        self._command = list(command)
        self._timeout = timeout
        self._process: subprocess.Popen[bytes] | None = None
        # Our ends of its standard input and output, while it runs.
        self._ends: list[DescriptorEnd] = []
        self._output = b""
        self._count = 0
        self._greeting: Json | None = None
        # Diagnostics go to a file, because a pipe that nobody reads would block when it is full.
        self._diagnostics = tempfile.TemporaryFile()  # noqa: SIM115  (closed by __exit__)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.stop()
        self._diagnostics.close()

    def ask(self, question: Json) -> Json:
        """Return the answer to a question; see :meth:`Implementation.ask`.

        Raises:
            LinkError: the command cannot be started at all.
            NoAnswer: no valid answer came.
        """
        if question["do"] == "hello":
            self._greeting = question
        elif self._process is None and self._greeting is not None:
            # A new process must be greeted like the first one.
            self.ask(self._greeting)
        process = self._process or self._start()
        self._count += 1
        line = json.dumps({"id": self._count, **question}, separators=(",", ":")) + "\n"
        seconds = self._timeout * (STARTING if question["do"] == "hello" else 1)
        try:
            return self._parse(self._exchange(process, line.encode(), seconds))
        except NoAnswer:
            self.stop()
            raise

    def stop(self) -> None:
        """End the command; the next question starts it again."""
        process, self._process, self._output = self._process, None, b""
        if process is None:
            return
        while self._ends:
            self._ends.pop().close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(0.5)
        programs.end(process)

    def _start(self) -> subprocess.Popen[bytes]:
        name, pipe = " ".join(self._command), subprocess.PIPE
        process = programs.start(self._command, name, pipe, pipe, self._diagnostics)
        for stream in (process.stdin, process.stdout):
            assert stream is not None, "both are pipes"
            self._ends.append(DescriptorEnd(os.dup(stream.fileno()), name))
            stream.close()
        self._process = process
        return process

    def _exchange(self, process: subprocess.Popen[bytes], line: bytes, seconds: float) -> bytes:
        """Send a line, and return the next line of the answers."""
        deadline = time.monotonic() + seconds
        to_codec, output = self._ends
        try:
            to_codec.write(line)
            while b"\n" not in self._output:
                left = deadline - time.monotonic()
                data = output.read(max(0.0, left))
                if not data and left <= 0:
                    raise NoAnswer("silent", f"no answer within {seconds:g} s")
                self._output += data
                if len(self._output) > LONGEST_LINE:
                    raise NoAnswer("malformed", f"a line of more than {LONGEST_LINE} bytes")
        except LinkError:
            raise self._gone(process) from None
        answer, _, self._output = self._output.partition(b"\n")
        return answer

    def _parse(self, line: bytes) -> Json:
        try:
            answer = json.loads(line)
            too_deep = _is_deeper(answer, DEEPEST)
        except ValueError:
            raise NoAnswer("malformed", f"{line[:120]!r} is not JSON") from None
        except RecursionError:
            too_deep = True
        if too_deep:
            raise NoAnswer("malformed", f"{line[:120]!r}... is nested too deeply")
        if not isinstance(answer, dict) or answer.get("id") != self._count:
            raise NoAnswer(
                "malformed", f"{line[:120]!r} is not an answer to question {self._count}"
            )
        return answer

    def _gone(self, process: subprocess.Popen[bytes]) -> NoAnswer:
        try:
            code = process.wait(1.0)
        except subprocess.TimeoutExpired:
            return NoAnswer("silent", "it closed its output but is still running")
        how = programs.ending(code, self._diagnostics)
        if code:
            return NoAnswer("crashed", how)
        return NoAnswer("ended", f"it did not answer question {self._count}; {how}")


def _is_deeper(value: Any, levels: int) -> bool:
    """Return whether a value is nested deeper than ``levels``; recursion must stay bounded."""
    inner = [value] if isinstance(value, dict | list) else []
    for _ in range(levels):
        parts = [part.values() if isinstance(part, dict) else part for part in inner]
        inner = [p for part in parts for p in part if isinstance(p, dict | list)]
        if not inner:
            return False
    return True
