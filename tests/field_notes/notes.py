"""The field notes, quoted in pieces. Each piece has a case, a test elsewhere, or needs no test.

The notes are outside the repository. A test checks that the pieces cover all of the notes.
"""

from __future__ import annotations

NOTES = {
    "leak": "**Servo bus leak**: Feetech packets `FF FF ID LEN INSTR|ERR params CHK` "
    "(CHK = ~(sum of ID..params) & FF) interleaved with frames.",
    "leak packets": "Seen: `ff ff 01 04 02 38 02 be` (read 2 bytes at register 0x38), its reply "
    "`ff ff 01 04 00 ff 07 f4`, sync read `ff ff fe 0a 82 38 0f 01 02 03 04 05 06 19`, sync write "
    "`ff ff fe 0c 83 29 07 06 ...`, ping `ff ff 07 02 01 f5`.",
    "leak FE": "A servo checksum of FE directly in front of FE FE gives `FE FE FE LEN`: several "
    "field parsers lose that frame.",
    "text": "**Firmware text**: `cmd_len error` (again and again)",
    "panic": "then an ESP32 panic: `Guru Meditation Error: Core 1 panic'ed (LoadProhibited)...`, "
    "about 2.4 kB of register dump and backtrace, `Rebooting...`",
    "boot": "then about 277 NULs, and boot output sent at another baud rate (garbage, framing "
    "errors).",
    "merged": "**Late and merged replies**: the ack of an earlier command arrives glued to the "
    "next reply, e.g. `FE FE 03 10 01 FA` + a 0x20 reply in one read.",
    "late": "A reply was seen 727 ms after its request, most likely the answer to an older one.",
    "baud": "Wrong baud rate: short garbage such as `78 80 78`.",
    "echo": "No echo of the host's own bytes on most boards; the transponder echoes 0xA0 and 0xB2 "
    "frames.",
    "xon": "XON/XOFF left on: a 0x13 in the data stops the line. Raw mode is a must.",
    "dtr": "DTR/RTS high can hold the ESP32 in reset.",
    "again": "A reply comes within about 30 ms or never: waiting 30 / 60 / 120 / 250 / 500 ms got "
    "67 / 80 / 57 / 73 / 80 % of the replies on a sick line, asking once / twice / three times got "
    "76 / 86 / 92 %. **Asking a query again beats waiting longer.**",
    "round trip": "get_angles round trip: 8.3-9 ms (1 Mbaud, USB latency timer at 1 ms), 16-20.5 "
    "ms (timer at its default 16 ms: FTDI chips hold short replies back), 12-15 ms (M5, 115200), "
    "30 ms (320, 115200).",
    "polling": "Safe polling 10-20 Hz while the arm moves, 30+ Hz idle.",
    "flushing": "Flushing the input before each request threw away replies that were only late, "
    "and caused unbroken timeouts; keeping the buffer and matching cured it.",
    "two writers": "Two processes, or two threads, writing to one port interleave bytes; the "
    "firmware answers `cmd_len error` and may panic.",
    "no checksum": "There is no checksum: a damaged send_angles is simply an angle that the arm "
    "obeys.",
    "0x19": "Unsupported status queries (0x19) froze one firmware until a power cycle.",
    "0x53": "A two-byte 0x53 read gave wrong values on another.",
    "line rate": "115200 baud carries 678 get_angles replies a second, 1 Mbaud 5,882.",
    "unanswered": "A command that the firmware does not answer is sent three times and takes 1.5 "
    "s, relative moves included.",
    "pause": "A pause of 100 ms inside a reply raises struct.error out of get_angles.",
    "other frame": "A valid frame of another command in front of the wanted one: -1 after three "
    "sends, the good frame thrown away each time.",
    "split": "Over TCP one recv is taken for one frame: a reply split after 8 bytes gives 2 of 6 "
    "joints, silently.",
    "truncated": "angle x100 is truncated: 6.4 % of all raw angles do not survive decode and "
    "encode.",
    "vanished": "A vanished port is logged, and the call returns -1 after 1.5 s.",
    "minus one": "Fails by returning -1 even where a list is promised.",
}

# Notes that a case on a pty or over TCP cannot cover.
ELSEWHERE = {
    "dtr": "tests/transport/test_port.py::test_dtr_and_rts_are_lowered_together",
    "0x19": "tests/client/test_field_notes.py::test_no_edition_has_the_query_that_froze_an_arm",
    "truncated": (
        "tests/codec/test_every_raw_value.py::test_every_raw_value_of_every_field_survives_decode_and_encode"
    ),
}

# Figures of other people's machines: they say nothing about a client's behaviour.
FIGURES = {
    "round trip": "bench/client.py measures what the client adds to it",
    "polling": "the caller chooses the rate",
    "line rate": "10 bits a byte, 17 bytes a reply",
}
