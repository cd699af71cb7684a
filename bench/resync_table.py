"""Format the rows of the resync report."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

READERS = ("cobotwire", "any LEN to 64", "textbook", "pymycobot", "pymycobot asked")

HEAD = """\
Recovered: % of the undamaged frames. Lost: how many of them we did not find because a false frame
that the table allows covers them, + how many without this reason. Wrong: accepted frames that were
not sent: damaged but legal, + phantoms. To next: bytes from a damage to the next undamaged frame
that was found, median/99 %/most; ideal is the least possible. Late: how many of our frames needed
bytes after their own, and at most how many.
Readers: ours; the same scan with any id and any LEN up to 64; a textbook state machine; pymycobot's
own code, reading continuously, and with one request for each reply.
"""
COLUMNS = (
    f"{'edition':10} {'stream':9} {'damage':12} {'rate':>6} {'undamaged':>9} |"
    f"{'recovered %':^40}|{'lost':>7} |{'wrong':^26}|{'to next undamaged frame':^55}| late\n"
    f"{'':50} |{'ours':>7} {'anyLEN':>7} {'textbk':>7} {'pymyc':>7} {'asked':>7} |{'ours':>7} |"
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
    """Format the value of the table compared with a bound on LEN alone."""
    lines = [
        "",
        "Stream A with 10 % line noise, read by the same scan, but any id with any LEN up to",
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
            f"  {name:15} lost {lost:6} ({100 * lost / undamaged:.4f} %), damaged but legal"
            f" {altered}, phantoms {phantoms}, damaged but read right {restored}"
        )
    late = [row["late"] for row in rows]
    lines.append(
        f"  of ours {sum(each['late'] for each in late)} of {sum(each['frames'] for each in late)}"
        f" came late, by {max(each['most'] for each in late)} bytes at most (fed byte by byte)"
    )
    covered = [(row, each) for row in rows for each in row["covered"]]
    lines += ["", f"Undamaged frames that a legal false frame covers: {len(covered)}"]
    for kind in dict.fromkeys(row["kind"] for row in rows):
        count = sum(where["kind"] == kind for where, _ in covered)
        lines += [f"  {kind}: {count}"] if count else []
    for where, each in covered[: max(show, 0)]:
        lines.append(
            f"  {where['edition']}, {where['kind']} at {where['rate']:g}: the frame at"
            f" {each['frame_at']} by the one at {each['by_false_at']}: {each['false']}"
        )
    if len(covered) > show:
        lines.append(f"  and {len(covered) - show} more (--show, --json)")
    bad = [(row, place) for row in rows for place in row["unexplained"]]
    lines.append(f"Undamaged frames lost without a legal false frame over them: {len(bad)}")
    lines += [f"  {where['edition']}, {where['kind']}: at {place}" for where, place in bad]
    return "\n".join(lines)


def _percent(reader: dict[str, Any]) -> str:
    # Rounded down: 100 is only what lost nothing at all.
    return "100" if not reader["lost"] else f"{min(100 * reader['share'], 99.999):.3f}"
