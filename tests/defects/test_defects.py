"""Each planted defect is found and named: here a sample; `make defects` tests all of them."""

from __future__ import annotations

import ast
import os
import sys

import pytest

from cobotwire.conformance import Report
from defects.arm import closed_loop, two_arms
from defects.arm.planted import DEFECTS
from defects.clients import report_on_client
from defects.devices import report_on_firmware, report_on_peer
from defects.key import HERE, Defect, Message, defects, messages_of, naming
from defects.makers_server import report_on_server

EVERY = "EVERY_DEFECT" in os.environ
KEY = list(defects())
# For each rule, a defect that only this rule finds; for each way to name a cause, a defect. Wrong
# bytes and wrong joints have one defect each; tests/mutation has a mutant of each kind.
SAMPLE = {
    "arm": (
        *("reply-of-the-request-before", "echo", "replies-in-reverse", "settings-coupled"),
        *("stores-forbidden-values", "never-gives-up-half-a-request", "any-instead-of-all", "dies"),
        *("pause-only-reports", "resume-discards", "limits-not-kept", "jog-one-way-only"),
        *("speed-of-motion-ignored", "y-mirrored", "encoder-of-one-joint-off"),
        *("limit-of-the-next-joint", "replies-to-unknown-ids", "never-stops", "tool-axes-swapped"),
    ),
    "closed_loop": tuple(closed_loop.DEFECTS),
    "two_arms": tuple(two_arms.DEFECTS),
    "client": ("truncates", "takes-text-for-the-reply", "moves-after-release"),
}
LINES = ("", "lost", "late", "noise", "text", "split", "twice", "merged")
# The lines or variants with which each subject without a defect must conform. The maker's server
# is left out: it has defects of its own.
CORRECT = {
    "arm": ("",),
    "closed_loop": tuple(closed_loop.CORRECT),
    "two_arms": ("",),
    "firmware": ("",),
    "client": LINES,
    "c_client": LINES,
}
# Correct subjects with varying delays, fast motions, or bytes between frames; and bad lines.
WAYS = ("", "acknowledges-at-different-times", "very-fast", "nul-now-and-then", "text", "late")
RUN = [defect for defect in KEY if EVERY or defect.switch in SAMPLE.get(defect.subject, ())]
RIGHT = [
    (subject, line)
    for subject, lines in CORRECT.items()
    for line in lines
    if EVERY or (subject in SAMPLE and line in WAYS)
]


def report_on(subject: str, defect: str = "", line: str = "") -> Report:
    """Test a subject with a defect.

    For a client, ``line`` names the fault of the referee's replies. For an arm in a closed loop
    without a defect it names the correct variant.
    """
    if subject in ("client", "c_client"):
        return report_on_client(subject, defect, line)
    if subject == "firmware":
        return report_on_firmware(defect)
    if subject == "server":
        return report_on_server(defect)
    return report_on_peer(subject, defect or line)


@pytest.mark.parametrize("defect", RUN, ids=lambda each: f"{each.subject}-{each.switch}")
def test_defect_is_named(defect: Defect) -> None:
    messages = messages_of(report_on(defect.subject, defect.switch, defect.line))
    named = naming(defect, messages)
    assert named, messages
    print(f"{defect.subject} {defect.switch}: {defect.what}: {named[0]}")


@pytest.mark.parametrize(("subject", "line"), RIGHT)
def test_correct_subject_conforms(subject: str, line: str) -> None:
    assert messages_of(report_on(subject, "", line)) == []


def test_key_lists_each_switch_of_the_subjects() -> None:
    assert {each.switch for each in KEY if each.subject == "arm"} == set(DEFECTS)
    for subject, source in {
        "closed_loop": "arm/closed_loop.py",
        "two_arms": "arm/two_arms.py",
        "firmware": "firmware/firmware.c",
        "c_client": "client/client.c",
        "client": "client/plain.py",
    }.items():
        text = (HERE / source).read_text("utf-8")
        for switch in (each.switch for each in KEY if each.subject == subject):
            name = f'"{switch}"' if source.endswith(".py") else f"DEFECT_{switch}"
            assert name in text, switch


@pytest.mark.parametrize("folder", ["arm", "client"])
def test_subjects_import_only_the_standard_library_and_each_other(folder: str) -> None:
    allowed = {*sys.stdlib_module_names, "defects.arm"}
    for path in (HERE / folder).glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            modules += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            for module in modules:
                first, second = module.split(".")[0], ".".join(module.split(".")[:2])
                assert first in allowed or second in allowed, (path, module)


@pytest.mark.parametrize(
    ("command", "text", "named"),
    [
        ("get_angles", "expected LEN 0E; received 0F", True),
        ("stop", "after get_angles: LEN is 0F", True),
        ("stop", "LEN is 0F", False),
        ("get_angles", "expected LEN 0E", False),
    ],
)
def test_message_names_a_cause_by_command_and_every_word(
    command: str, text: str, named: bool
) -> None:
    defect = Defect("arm", "x", "it is wrong", ("get_angles",), ("LEN", "0F"))
    assert bool(naming(defect, [Message("reply-frame", command, text)])) == named
