"""Format the rows of the resync report."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

READERS = ("cobotwire", "any LEN to 64", "textbook", "pymycobot", "pymycobot by request")

HEAD = f"""\
Lost: undamaged frames that a reader did not find. Covered: those that our reader did not find
because a false frame, legal by the table, covers them. The readers: ours; the same scan with any id
and any LEN up to 64; a textbook state machine; pymycobot's own code, reading continuously, and with
a request for each reply.

{"edition":10} {"stream":9} {"damage":12} {"rate":>6} {"undamaged":>9}   lost by each reader"""


def row(row: dict[str, Any]) -> str:
    """Format one line of the table."""
    stream = {"A": "A", "reply": "replies", "both": "both ways"}
    name = stream[row["stream"] if row["stream"] == "A" else row["listening"]]
    lost = "".join(f"{row['readers'][reader]['lost']:8}" for reader in READERS)
    covered = row["readers"][READERS[0]]["covered"]
    faults = "" if row["codecs_agree"] else "  THE CODECS DIFFER"
    return (
        f"{row['edition']:10} {name:9} {row['kind']:12} {row['rate']:>6g} {row['undamaged']:>9}"
        f"{lost}   {covered} covered{faults}"
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
