"""Several threads that read one stream return what one thread returns.

``rust/core/tests/workers.rs`` cuts small streams at every offset.
"""

from __future__ import annotations

import mmap
import os
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import strategies
from cobotwire.codec.interface import Codec, Columns, Data, Listening
from cobotwire.protocol.errors import UsageError
from codec.results import everything
from strategies import codec_of

ANGLES = bytes.fromhex("FE FE 0E 20 00 64 00 C8 01 2C 01 90 01 F4 02 8A FA")
# Frames that end with a footer; with an address and a sum; with a CRC.
FAMILIES = ("mycobot280", "mybuddy", "pro450")
# A stream of this many bytes is divided between threads.
LARGE = 9 << 20
LISTENING: st.SearchStrategy[Listening] = st.sampled_from(["request", "reply", "both"])


def processors() -> int:
    """Return the number of processors that this process may use."""
    if sys.platform == "linux":
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@pytest.mark.parametrize("edition", FAMILIES)
@settings(max_examples=8)
@given(listening=LISTENING, raw=st.booleans(), workers=st.integers(2, 5), data=st.data())
def test_large_stream_has_the_same_columns_with_several_threads(
    edition: str, listening: Listening, raw: bool, workers: int, data: st.DataObject
) -> None:
    codec = codec_of(edition, "native")
    drawn = data.draw(strategies.streams(codec.table)) or b"\0"
    stream = drawn * (LARGE // len(drawn) + 1)

    assert everything(codec.scan(stream, listening, workers=workers)) == everything(
        codec.scan(stream, listening)
    )
    assert everything(
        codec.decode_columns(stream, listening, raw=raw, workers=workers)
    ) == everything(codec.decode_columns(stream, listening, raw=raw))


@pytest.mark.parametrize("call", ["scan", "decode_columns"])
@pytest.mark.parametrize("workers", [0, -1, 65_536, 1 << 70, 1.5, "2", None])
def test_wrong_number_of_threads_is_refused_before_anything_is_read(
    codec: Codec, call: str, workers: Any
) -> None:
    method: Callable[..., Any] = getattr(codec, call)
    out = method(ANGLES * 3)
    with pytest.raises(UsageError) as error:
        method(ANGLES, out=out, workers=workers)
    assert str(error.value) == f"workers is {workers!r}; allowed: 1 to 65535"
    assert len(out) == len(method(ANGLES * 3)), "the memory was not taken"


@pytest.mark.parametrize("workers", [True, np.uint8(3), 65_535])
def test_number_of_threads_may_be_any_integer(codec: Codec, workers: Any) -> None:
    assert len(codec.scan(ANGLES * 3, workers=workers)) == 3


@pytest.mark.parametrize("raw", [False, True])
def test_threads_reuse_the_memory_of_out(raw: bool) -> None:
    codec = codec_of("mycobot280", "native")
    stream = (ANGLES + b"\x07") * (LARGE // 18)

    def places(found: Columns) -> list[int]:
        columns = (found[0].offset, found[0]["angles"], found.noise.offset, found.noise.size)
        return [np.asarray(column).ctypes.data for column in columns]

    first = codec.decode_columns(stream, "reply", raw=raw, workers=2)
    before, expected = places(first), everything(first)
    second = codec.decode_columns(stream, "reply", raw=raw, out=first, workers=2)
    assert places(second) == before
    assert everything(second) == expected


@pytest.mark.parametrize("kind", ["bytearray", "memoryview", "mmap"])
def test_threads_read_every_kind_of_buffer(kind: str) -> None:
    codec = codec_of("mycobot280", "native")
    stream = ANGLES * (2 * LARGE // 17) + ANGLES[:5]
    kinds: dict[str, Callable[[bytes], Data]] = {
        "bytearray": bytearray,
        "memoryview": memoryview,
        "mmap": mapped,
    }
    expected = codec.decode_columns(stream, "reply")
    assert everything(codec.decode_columns(kinds[kind](stream), "reply", workers=2)) == everything(
        expected
    )


def mapped(data: bytes) -> mmap.mmap:
    """Return memory that is mapped, with these bytes."""
    found = mmap.mmap(-1, len(data))
    found.write(data)
    return found


@pytest.mark.skipif(processors() < 2, reason="needs two processors")
def test_threads_share_the_work() -> None:
    codec = codec_of("mycobot280", "native")
    stream = ANGLES * (4 * LARGE // 17)
    out = codec.decode_columns(stream, "reply", workers=2)
    mine, all_threads = time.thread_time(), time.process_time()
    codec.decode_columns(stream, "reply", out=out, workers=2)
    mine, all_threads = time.thread_time() - mine, time.process_time() - all_threads
    assert 0.2 * all_threads < mine < 0.8 * all_threads


NO_STACK = f"""
from strategies import codec_of
codec = codec_of("mycobot280", "native")
stream = bytes.fromhex("{ANGLES.hex()}") * ({LARGE} // 17)
found = codec.decode_columns(stream, "reply", workers=2)
assert bytes(found[0].offset) == bytes(codec.decode_columns(stream, "reply")[0].offset)
print(len(found[0]))
"""


@pytest.mark.skipif(sys.platform != "linux", reason="other systems refuse in other ways")
def test_one_thread_reads_if_the_system_refuses_others() -> None:
    # Rust takes the size of a thread's stack from RUST_MIN_STACK; no system has this much memory.
    environment = {**os.environ, "RUST_MIN_STACK": str(sys.maxsize // 8)}
    result = subprocess.run(
        [sys.executable, "-c", NO_STACK],
        env={**environment, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (result.stdout, result.stderr) == (f"{LARGE // 17}\n", "")
