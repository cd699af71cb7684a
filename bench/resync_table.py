"""Format the rows of the resync report."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

READERS = ("cobotwire", "any LEN to 64", "textbook", "pymycobot", "pymycobot by request")

HEAD = """\
Recovered: the share of the undamaged frames that a reader found. Lost: undamaged frames that we did
not find: covered by a false frame that the table allows, + not covered. Wrong: accepted frames that
were not sent: damaged but legal, + phantoms. To next undamaged frame: bytes from a damage to the
next undamaged frame that was found (median/99 %/most); ideal is the least possible. Late: how many
of our frames were delivered after their last byte, and the largest number of bytes in between.
Readers: ours; the same scan with any id and any LEN up to 64; a textbook state machine; pymycobot's
own code, reading continuously, and with one request for each reply (by req).
"""
COLUMNS = (
    f"{'edition':10} {'stream':9} {'damage':12} {'rate':>6} {'undamaged':>9} |"
    f"{'recovered %':^40}|{'lost':>7} |{'wrong':^26}|{'to next undamaged frame':^55}| late\n"
    f"{'':50} |{'ours':>7} {'anyLEN':>7} {'textbk':>7} {'pymyc':>7} {'by req':>7} |{'ours':>7} |"
    f"{'ours':>8} {'textbk':>8} {'pymyc':>8}|"
    f"{'ideal':>13} {'ours':>13} {'textbk':>13} {'pymyc':>13}| ours"
)


def row(row: dict[str, Any]) -> str:
    """Format one line of the table."""
    readers = [row["readers"][name] for name in READERS]
    some = [readers[0], readers[2], readers[3]]
    stream = {"A": "A", "reply": "replies", "both": "both ways"}
    name = stream[row["stream"] if row["stream"] == "A" else row["listening"]]
    shares = " ".join(f"{_percent(each):>7}" for each in readers)
    lost = f"{readers[0]['covered']}+{len(row['unexplained'])}"
    wrong = " ".join(f"{each['altered']}+{each['phantoms']}".rjust(8) for each in some)
    spreads = [row["ideal"], *(each["bytes_to_recovery"] for each in some)]
    distances = " ".join(
        f"{each['median']}/{each['p99']}/{each['max']}".rjust(13) for each in spreads
    )
    late = f"{row['late']['late']}, {row['late']['most']}"
    faults = "" if row["codecs_agree"] else "  THE CODECS DIFFER"
    return (
        f"{row['edition']:10} {name:9} {row['kind']:12} {row['rate']:>6g} {row['undamaged']:>9} |"
        f"{shares} |{lost:>7} |{wrong}|{distances}| {late}{faults}"
    )


def bounds(rows: Sequence[dict[str, Any]]) -> str:
    """Format the losses with the table, and with only a bound on LEN."""
    lines = [
        "",
        "Stream A with 10 % line noise: scanned with the table, or with any id and a bound on LEN",
    ]
    for each in rows:
        lines.append(
            f"  {each['edition']:10} {each['bound']:>9}: {100 * each['share']:.3f} % recovered,"
            f" {each['phantoms']} phantoms"
        )
    return "\n".join(lines)


def summary(rows: Sequence[dict[str, Any]], show: int) -> str:
    """Format the lost and wrong frames of all rows, and each lost frame."""
    undamaged = sum(row["undamaged"] for row in rows)
    lines = ["", f"All rows together: {undamaged} undamaged frames."]
    for name in READERS:
        readers = [row["readers"][name] for row in rows]
        lost, altered, restored, phantoms = (
            sum(each[key] for each in readers)
            for key in ("lost", "altered", "restored", "phantoms")
        )
        lines.append(
            f"  {name:20} lost {lost:6} ({100 * lost / undamaged:.4f} %), damaged but legal"
            f" {altered}, phantoms {phantoms}, damaged but read correctly {restored}"
        )
    late = [row["late"] for row in rows]
    lines.append(
        f"  late {sum(each['late'] for each in late)} of {sum(each['frames'] for each in late)}"
        f" of our frames, by {max(each['most'] for each in late)} bytes at most (fed byte by byte)"
    )
    covered = [(row, each) for row in rows for each in row["covered"]]
    lines += ["", f"Undamaged frames that a legal false frame covers: {len(covered)}"]
    for kind in dict.fromkeys(row["kind"] for row in rows):
        count = sum(where["kind"] == kind for where, _ in covered)
        lines += [f"  {kind}: {count}"] if count else []
    for where, each in covered[: max(show, 0)]:
        lines.append(
            f"  {where['edition']}, {where['kind']} at {where['rate']:g}: the false frame at"
            f" {each['by_false_at']} covers the frame at {each['frame_at']}: {each['false']}"
        )
    if len(covered) > show:
        lines.append(f"  and {len(covered) - show} more (--show, --json)")
    bad = [(row, place) for row in rows for place in row["unexplained"]]
    lines.append(f"Undamaged frames lost that no legal false frame covers: {len(bad)}")
    lines += [f"  {where['edition']}, {where['kind']}: at {place}" for where, place in bad]
    return "\n".join(lines)


def _percent(reader: dict[str, Any]) -> str:
    # Rounded down, so that only a reader that loses no frame gets 100.
    return "100" if not reader["lost"] else f"{min(100 * reader['share'], 99.999):.3f}"
