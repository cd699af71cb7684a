"""Runs a program as if this package were the maker's library."""

from __future__ import annotations

import runpy
import sys
import threading
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType, TracebackType
from typing import Literal

from cobotwire.protocol.errors import CobotwireError, UsageError
from cobotwire.pymycobot.layer.absent import why_no
from cobotwire.pymycobot.layer.policy import policy

LIBRARY = "pymycobot"
_OURS = "cobotwire.pymycobot"
INTERRUPTED = 130
_PACKAGE = Path(__file__).parents[1]


class _Alias(MetaPathFinder, Loader):
    """Finds our modules under the names of the library's."""

    def find_spec(
        self, fullname: str, path: object = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        package, _, rest = fullname.partition(".")
        if package != LIBRARY:
            return None
        if find_spec(_ours(fullname)) is None:
            unknown = f"cobotwire has no {fullname}: no edition covers what that module drives"
            raise ModuleNotFoundError(why_no(fullname) or unknown, name=fullname)
        return ModuleSpec(fullname, self, is_package=not rest)

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        return import_module(_ours(spec.name))

    def exec_module(self, module: ModuleType) -> None:
        """Do nothing: the module was executed under its own name."""


def _ours(name: str) -> str:
    return _OURS + name.removeprefix(LIBRARY)


@contextmanager
def as_library() -> Iterator[None]:
    """Import this package wherever a program imports the library; nothing installed changes."""
    before = {name: sys.modules.pop(name) for name in list(sys.modules) if _is_library(name)}
    alias = _Alias()
    sys.meta_path.insert(0, alias)
    try:
        yield
    finally:
        sys.meta_path.remove(alias)
        for name in [name for name in sys.modules if _is_library(name)]:
            del sys.modules[name]
        sys.modules.update(before)


def _is_library(name: str) -> bool:
    return name.partition(".")[0] == LIBRARY


def run_program(
    path: str, arguments: Sequence[str] = (), errors: Literal["raise", "return"] = "raise"
) -> int:
    """Run a program of the maker's library on our clients.

    Its arms are closed when it and its threads have ended. If an exception, Ctrl-C or an exit code
    other than 0 ends it, or an exception one of its threads, each arm is first sent ``stop`` once,
    also if the program no longer refers to it.

    Args:
        path: the program's file.
        arguments: what follows the file on its command line.
        errors: what a call that fails does, unless the program itself chooses that.

    Returns:
        The exit code of the program; 1 if an exception ended it or one of its threads; 130 after
        Ctrl-C.

    Raises:
        UsageError: there is no such file.
    """
    if not Path(path).is_file():
        problem = "is a folder; name a program in it" if Path(path).is_dir() else "no such file"
        raise UsageError("script", path, message=f"{path}: {problem}")
    policy.errors = errors
    saved = sys.argv, sys.path[:]
    sys.argv = [path, *arguments]
    sys.path.insert(0, str(Path(path).resolve().parent))
    try:
        with as_library():
            return _run(path)
    finally:
        sys.argv, sys.path[:] = saved
        policy.errors = "raise"


def _run(path: str) -> int:
    error: BaseException | None = None
    before = set(threading.enumerate())
    with policy.running(), _errors_of_threads() as failed:
        try:
            try:
                runpy.run_path(path, run_name="__main__")
                _join(set(threading.enumerate()) - before)
                code = 0
            except SystemExit as ended:
                code = _exit_code(ended)
                error = ended if code else None
            if not code and failed:
                code, error = 1, failed[0]
            return code
        except BaseException as raised:
            error = raised
            return _report(raised, path)
        finally:
            _leave(error)


@contextmanager
def _errors_of_threads() -> Iterator[list[BaseException]]:
    """Yield the errors that end threads of the program; Python prints them as always."""
    errors: list[BaseException] = []
    show = threading.excepthook

    def note(failed: threading.ExceptHookArgs) -> None:
        # SystemExit is a regular end of a thread.
        if not issubclass(failed.exc_type, SystemExit):
            errors.append(failed.exc_value or failed.exc_type())
        show(failed)

    threading.excepthook = note
    try:
        yield errors
    finally:
        threading.excepthook = show


def _join(threads: set[threading.Thread]) -> None:
    """Wait for the program's threads, which go on using the arms after its last line."""
    for thread in threads:
        if not thread.daemon:
            thread.join()


def _exit_code(ended: SystemExit) -> int:
    if ended.code is None or isinstance(ended.code, int):
        return ended.code or 0
    print(ended.code, file=sys.stderr)
    return 1


def _report(error: BaseException, path: str) -> int:
    """Print the traceback from the program's first line on, and return the exit code."""
    if isinstance(error, KeyboardInterrupt):
        return INTERRUPTED
    frames = error.__traceback__
    while frames is not None and frames.tb_frame.f_code.co_filename != path:
        frames = frames.tb_next
    if isinstance(error, CobotwireError):
        _hide_ours(frames)
        error.__suppress_context__ = True
    traceback.print_exception(error.with_traceback(frames or error.__traceback__))
    return 1


def _hide_ours(frames: TracebackType | None) -> None:
    """Cut the traceback at the first frame of this package: the error itself says what is wrong."""
    while frames is not None and (after := frames.tb_next):
        if Path(after.tb_frame.f_code.co_filename).is_relative_to(_PACKAGE):
            frames.tb_next = None
        frames = after


def _leave(error: BaseException | None) -> None:
    """Close every arm of the program; first stop it if an error ended the program."""
    for arm in policy.arms():
        try:
            arm.__exit__(type(error) if error else None, error, None)
        except CobotwireError as failed:
            print(f"cobotwire: {failed}", file=sys.stderr)
