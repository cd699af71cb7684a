"""A client in a process of its own, with the methods of a blocking client: in Rust or in Node.

``rust/probe/src/client.rs`` or ``tests/typescript/driver.mjs`` is the other end of the pipe. Each
line is a JSON object. Each call has a number; the answer has the same number, and the times at
which the client began and ended the call.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError, Future
from importlib import import_module
from importlib.resources import as_file, files
from itertools import count
from pathlib import Path
from typing import Any, Self

import probe
from cobotwire.protocol import errors
from cobotwire.protocol.table import Table

JSON = dict[str, Any]
# The process has ended if it does not open or close its client within this time.
CONTROL_SECONDS = 10.0
# Starts a client in Node; its package must have been built (tools/npm_package.py).
NODE = ("node", str(Path(__file__).parent / "typescript/driver.mjs"))


class ProbeClient:
    """A client of the probe. Threads may share it: each call waits for its own answer.

    Attributes:
        process: the probe's process.
    """

    def __init__(
        self,
        url: str,
        edition: str,
        *,
        written: Callable[[JSON], None] = lambda line: None,
        ended: Callable[[float, float], None] = lambda began, ended: None,
        command: Sequence[str] = (),
        **options: Any,
    ) -> None:
        """Start the process, and open its client.

        ``written`` is called with each write, in its order; ``ended`` with the times of each call,
        in the thread of the caller. ``options``: see ``Options`` of the Rust file.
        """
        self._table: Table = import_module(f"cobotwire.editions.{edition}").TABLE
        self._written, self._ended = written, ended
        self._numbers = count(1)
        self._answers: dict[int, Future[JSON]] = {}
        self._writing = threading.Lock()
        with as_file(files(f"cobotwire.editions.{edition}") / "edition.json") as path:
            self.process = subprocess.Popen(
                [*(command or [probe.path()]), "client", str(path), url, json.dumps(options)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
                bufsize=1,
            )
            self._reader = threading.Thread(target=self._read, daemon=True)
            self._reader.start()
            try:
                self.open()
            except BaseException:
                self.end()
                raise

    def __getattr__(self, name: str) -> Any:
        return lambda *arguments, **options: self._call(name, arguments, options)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()
        self.end()

    def open(self) -> None:
        """Open the client again; calls use it from then on."""
        self._control(open=True)

    def close(self) -> None:
        """Close the client; calls in other threads end with an error."""
        self._control(close=True)

    def cancelled_after(self, seconds: float, name: str) -> Callable[..., Any]:
        """Return a method whose task is cancelled after some seconds."""

        def call(*arguments: Any, **options: Any) -> Any:
            number = next(self._numbers)
            timer = threading.Timer(seconds, self._send, [{"give_up": number}])
            timer.start()
            try:
                return self._call(name, arguments, options, number)
            finally:
                timer.cancel()

        return call

    def end(self) -> None:
        """End the process; its unfinished calls raise an error."""
        assert self.process.stdin is not None, "it is a pipe"
        self.process.stdin.close()
        try:
            self.process.wait(CONTROL_SECONDS)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self._reader.join()
        assert self.process.stdout is not None, "it is a pipe"
        self.process.stdout.close()

    def _call(self, name: str, arguments: Sequence[Any], options: JSON, number: int = 0) -> Any:
        command = self._table.command(name)
        fields = dict(zip(command.argument_names, arguments, strict=False))
        answer = self._ask({"call": name, "fields": fields, **options}, number).result()
        if "began" in answer:
            self._ended(answer["began"], answer["ended"])
        _raise_error(answer)
        echoed = {f.name for variant in command.reply for f in variant.fields if f.echo}
        result: JSON = answer["result"] or {}
        # The rows of our clients are tuples.
        values = tuple(
            tuple(value) if isinstance(value, list) else value
            for name, value in result.items()
            if name not in echoed
        )
        return values[0] if len(values) == 1 else values or None

    def _control(self, **line: bool) -> None:
        _raise_error(self._ask(line).result(CONTROL_SECONDS))

    def _ask(self, line: JSON, number: int = 0) -> Future[JSON]:
        number = number or next(self._numbers)
        answer = self._answers[number] = Future()
        self._send({"id": number, **line})
        return answer

    def _send(self, line: JSON) -> None:
        assert self.process.stdin is not None, "it is a pipe"
        with self._writing:
            self.process.stdin.write(json.dumps(line) + "\n")

    def _read(self) -> None:
        assert self.process.stdout is not None, "it is a pipe"
        for text in self.process.stdout:
            line = json.loads(text)
            if "handed" in line:
                self._written(line)
            else:
                self._answers.pop(line["id"]).set_result(line)
        for answer in tuple(self._answers.values()):
            answer.set_exception(RuntimeError("the probe's process ended"))


class Stopped:
    """Stops a process while a ``with`` block runs, so that it writes nothing.

    Attributes:
        times: when it ran again, and for how many seconds it had been stopped.
    """

    def __init__(self, process: int) -> None:
        self.times: list[tuple[float, float]] = []
        self._process = process
        self._began = 0.0

    def __enter__(self) -> None:
        self._began = time.monotonic()
        os.kill(self._process, signal.SIGSTOP)
        os.waitid(os.P_PID, self._process, os.WSTOPPED)

    def __exit__(self, *raised: object) -> None:
        os.kill(self._process, signal.SIGCONT)
        now = time.monotonic()
        self.times.append((now, now - self._began))


def _raise_error(answer: JSON) -> None:
    """Raise the error of an answer, as the class of ours that has its name."""
    name = answer.get("error")
    if name is None:
        return
    if name == "Cancelled":
        raise CancelledError
    kind = getattr(errors, name, RuntimeError)
    # Our constructors take the data of an error; the answer has its text.
    error = kind.__new__(kind)
    error.args = (answer["text"],)
    raise error
