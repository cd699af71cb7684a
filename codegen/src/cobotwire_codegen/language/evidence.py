"""Evidence files: what real arms showed of the facts of an edition, one file for each run."""

from __future__ import annotations

from cobotwire_codegen.language.names import LOWER
from cobotwire_codegen.language.proof import VECTOR
from cobotwire_codegen.language.records import Listed, Record, optional, required
from cobotwire_codegen.language.shapes import Name, Text, Texts, Word

KINDS = {
    "survey": "A run of `cobotwire survey` with a real arm.",
    "conformance test": "A run of `cobotwire conform device` with a real arm.",
}
VERDICTS = ("confirmed", "contradicted")


class ObservedFact(Record):
    """What an arm showed of one fact."""

    fact = required(
        Text(),
        "The fact: COMMAND/PART/ASPECT. The part is `command`, `request`, `reply`, "
        "`request.ARGUMENT` or `reply.FIELD`.",
    )
    verdict = required(Word(VERDICTS), "Whether the arm does what the edition states.")
    why = optional(Text(), "What the arm did instead.")
    frames = optional(Texts(), "The frames that show it, as pairs of hex digits.")
    EXAMPLE = """\
fact: get_angles/reply.angles/scale
verdict: contradicted
why: The angles are tenths of a degree.
frames: ["FE FE 0E 20 00 64 00 00 00 00 00 00 00 00 00 00 FA"]
"""


class EvidenceFile(Record):
    """What one arm showed. `cobotwire-gen evidence add` writes it.

    A contradicted fact becomes a dispute of its command. The confidence is high if more arms
    confirm the fact than contradict it, low if fewer do, else medium. A delta does not inherit the
    evidence of its base, which describes another robot.
    """

    evidence = required(Name(LOWER), "The edition.")
    kind = required(Word(KINDS, KINDS.values()), "How the arm was observed.")
    robot = required(Text(), "The robot, as its owner names it.")
    firmware = optional(Text(), "What the robot reports as its firmware.")
    date = required(Text(), "The day of the run, such as 2026-11-24.")
    digest = required(Text(), "The SHA-256 of the file that the run wrote.")
    facts = required(Listed(ObservedFact), "The facts that the run observed.")
    vectors = optional(Listed(VECTOR), "Frames of the arm with the values that they carry.")
