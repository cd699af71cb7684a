"""In a subinterpreter the native codec is refused, and the reference takes its place.

Each test runs in a process of its own, since an extension module that two interpreters share can
crash both.
"""

from __future__ import annotations

import importlib.util
import subprocess
import sys

import pytest

NAME = "_xxsubinterpreters" if sys.version_info < (3, 13) else "_interpreters"
pytestmark = pytest.mark.skipif(
    importlib.util.find_spec(NAME) is None, reason="this interpreter has no subinterpreters"
)
# Runs code in a subinterpreter that shares the GIL; if the code fails, so does this process.
START = f"""
import sys
import {NAME} as interpreters

def make():
    if sys.version_info < (3, 13):
        return interpreters.create(isolated=False)
    return interpreters.create("legacy")

def run(interpreter, code):
    code = f"import sys\\nsys.path[:] = {{sys.path!r}}\\n" + code
    if sys.version_info < (3, 13):
        interpreters.run_string(interpreter, code)
    else:
        failed = interpreters.exec(interpreter, code)
        assert failed is None, failed.errdisplay
"""
# Decodes and encodes, and checks that every result and error is of a class of this interpreter.
USE = """
from cobotwire import codec as codecs
from cobotwire.codec.interface import DecodedMessage, Frame, Noise
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.errors import ProtocolError, UsageError

def use(expected):
    assert codecs.chosen() == expected, codecs.chosen()
    codec = codecs.load(TABLE)
    assert codec.name == expected
    for wrong, action in [
        (ProtocolError, lambda: codec.decode("reply", b"abc")),
        (UsageError, lambda: codec.encode("send_angles", "request", ((999,) * 6, 50))),
    ]:
        try:
            action()
        except wrong:
            pass
        else:
            raise AssertionError("no error")
    noise, frame = codec.framer("reply").feed(b"abc" + bytes.fromhex("FE FE 03 12 01 FA"))
    assert type(noise) is Noise and isinstance(frame, Frame)
    assert type(frame.message) is DecodedMessage
    assert len(codec.decode_columns(frame.data, "reply")) == 1
"""
IN_SUBINTERPRETER = (
    USE
    + """
use("reference")
try:
    codecs.load(TABLE, "native")
except UsageError as error:
    text = str(error)
    assert "cannot be loaded (cobotwire._native works only in the main" in text, text
    assert "use 'reference'" in text, text
else:
    raise AssertionError("the native codec was loaded")
try:
    import cobotwire._native
except ImportError as error:
    assert "only in the main interpreter" in str(error), error
else:
    raise AssertionError("the binary was imported")
"""
)


def _run(script: str) -> None:
    text = f"SUB = {IN_SUBINTERPRETER!r}\n{USE}\n{START}\n{script}"
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr[-3000:]


def test_main_interpreter_after_a_subinterpreter_gets_the_native_codec() -> None:
    _run("sub = make()\nrun(sub, SUB)\ninterpreters.destroy(sub)\nuse('native')")


def test_several_subinterpreters_each_get_their_own_classes() -> None:
    _run(
        "use('native')\n"
        "for _ in range(3):\n"
        "    sub = make()\n"
        "    run(sub, SUB)\n"
        "    interpreters.destroy(sub)\n"
        "    use('native')\n"
    )


def test_native_codec_forced_in_a_subinterpreter_is_an_error_with_the_reason(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("COBOTWIRE_CODEC", "native")
    _run("""
run(make(), '''
from cobotwire import codec as codecs
from cobotwire.protocol.errors import UsageError
try:
    codecs.chosen()
except UsageError as error:
    assert "COBOTWIRE_CODEC=native: the native codec cannot be loaded" in str(error), error
else:
    raise AssertionError("no error")
''')
use("native")
""")
