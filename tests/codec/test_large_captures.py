"""Bound the memory for large captures, and the decoding time for adversarial input."""

from __future__ import annotations

import subprocess
import sys
import time

import pytest

from cobotwire.codec.interface import Codec
from strategies import codec_of

ANGLES = bytes.fromhex("FE FE 0E 20 00 64 00 C8 01 2C 01 90 01 F4 02 8A FA")
LONGEST = 32
MIB = 1 << 20
# Adversarial patterns: none contains a frame, and each looks like the start of one.
HARD = {
    "all FE": b"\xfe",
    "FE FE FF": b"\xfe\xfe\xff",
    "FE FE and the longest LEN": b"\xfe\xfe\x1a",
    "a legal header every 4 bytes": ANGLES[:4],
}

PEAK = """
import sys
from cobotwire import codec
from cobotwire.editions.mycobot280 import TABLE

def peak():
    status = open("/proc/self/status").read()
    return int(status.partition("VmHWM:")[2].split()[0]) * 1024

native = codec.load(TABLE, "native")
native.decode_columns(bytes(2_000_000), "reply")
frame = bytes.fromhex(sys.argv[1])
before = peak()
"""


def _run(script: str) -> int:
    command = [sys.executable, "-c", PEAK + script, ANGLES.hex()]
    return int(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


@pytest.mark.skipif(sys.platform != "linux", reason="reads the peak from Linux's /proc")
@pytest.mark.parametrize("raw", [False, True])
def test_peak_memory_is_input_plus_output_plus_a_tenth(raw: bool) -> None:
    taken = _run(f"""
data = frame * 1_000_000
rows = native.decode_columns(data, "reply", raw={raw})[0]
output = rows.offset.nbytes + rows["angles"].nbytes
assert len(rows) == 1_000_000
print(round((peak() - before) * 1000 / (len(data) + output)))
""")
    assert taken <= 1100


@pytest.mark.skipif(sys.platform != "linux", reason="reads the peak from Linux's /proc")
def test_memory_for_a_stream_does_not_grow_with_the_number_of_chunks() -> None:
    grown = _run("""
reader = native.column_reader("reply")
piece = frame * (1 << 16)
rows = 0
for turn in range(100):
    rows += sum(map(len, reader.feed(piece[turn % 17:] + piece[:turn % 17])))
    if turn == 10:
        before = peak()
rows += sum(map(len, reader.flush()))
assert rows > 6_400_000, rows
print(peak() - before)
""")
    assert grown < 4 * MIB


@pytest.mark.parametrize("name", HARD)
def test_reader_keeps_at_most_a_frame_between_calls(codec: Codec, name: str) -> None:
    size = MIB if codec.name == "native" else 20_000
    data = HARD[name] * (size // len(HARD[name]))
    reader, framer = codec.column_reader("reply"), codec.framer("reply")
    columns = reader.feed(data)
    framer.feed(data)
    assert reader.pending == framer.pending < LONGEST
    assert len(columns) == 0
    assert len(columns.noise.offset) == 0, "the only span of noise has not ended yet"
    assert len(reader.flush().noise.offset) == 1


@pytest.mark.parametrize("name", HARD)
def test_time_for_adversarial_input_grows_in_proportion_to_its_size(name: str) -> None:
    codec = codec_of("mycobot280", "native")

    def seconds(size: int) -> float:
        data = HARD[name] * (size // len(HARD[name]))
        turns = []
        for _ in range(5):
            started = time.thread_time()
            codec.scan(data, "reply")
            turns.append(time.thread_time() - started)
        return min(turns)

    # Quadratic work would take 64 times as long; a busy machine adds far less.
    assert seconds(16 * MIB) < 20 * seconds(2 * MIB)
