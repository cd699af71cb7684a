"""A sample of the planted defects is found and named; `make defects` runs all of them."""

from __future__ import annotations

import ast
import sys

import pytest

from defects.arm import closed_loop, two_arms
from defects.arm.planted import DEFECTS
from defects.clients import report_on_client
from defects.devices import report_on_arm, report_on_closed_loop, report_on_two_arms
from defects.key import HERE, SUBJECTS, Defect, defects
from defects.listing import figures, line
from defects.verdicts import Message, messages_of, verdict_on

KEY = {(defect.subject, defect.switch): defect for defect in defects()}
# For each rule one defect that only this rule finds, and one for each way to name a cause. For
# wrong bytes and wrong parts there is one defect each; tests/mutation has a mutant of each kind.
ARM = (
    *("reply-of-the-request-before", "echo", "replies-in-reverse", "settings-coupled"),
    *("stores-forbidden-values", "never-gives-up-half-a-request", "any-instead-of-all", "dies"),
    *("pause-only-reports", "resume-discards", "limits-not-kept", "jog-one-way-only"),
    *("speed-of-motion-ignored", "y-mirrored", "encoder-of-one-joint-off"),
    *("limit-of-the-next-joint", "replies-to-unknown-ids", "never-stops", "tool-axes-swapped"),
)
# Acknowledgements at other times, motions of another speed, and bytes between frames.
WAYS = ("", "acknowledges-at-different-times", "very-fast", "nul-now-and-then")
CLIENTS = ("truncates", "takes-text-for-the-reply", "moves-after-release")


@pytest.mark.parametrize("switch", ARM)
def test_defect_of_the_arm_is_named(switch: str) -> None:
    verdict = verdict_on(KEY["arm", switch], messages_of(report_on_arm(switch)))
    assert verdict.named, verdict.messages


def test_correct_arm_conforms() -> None:
    assert messages_of(report_on_arm()) == []


@pytest.mark.parametrize("switch", closed_loop.DEFECTS)
def test_defect_of_the_closed_loop_is_named(switch: str) -> None:
    verdict = verdict_on(KEY["closed_loop", switch], messages_of(report_on_closed_loop(switch)))
    assert verdict.named, verdict.messages


@pytest.mark.parametrize("switch", two_arms.DEFECTS)
def test_defect_of_two_arms_is_named(switch: str) -> None:
    verdict = verdict_on(KEY["two_arms", switch], messages_of(report_on_two_arms(switch)))
    assert verdict.named, verdict.messages


def test_correct_two_arms_conform() -> None:
    assert messages_of(report_on_two_arms()) == []


@pytest.mark.parametrize("way", WAYS)
def test_correct_closed_loop_conforms(way: str) -> None:
    assert messages_of(report_on_closed_loop(way)) == []


@pytest.mark.parametrize("switch", CLIENTS)
def test_defect_of_the_client_is_named(switch: str) -> None:
    defect = KEY["client", switch]
    verdict = verdict_on(defect, messages_of(report_on_client(switch, defect.line)))
    assert verdict.named, verdict.messages


@pytest.mark.parametrize("line", ["", "text", "late"])
def test_correct_client_conforms(line: str) -> None:
    assert messages_of(report_on_client("", line)) == []


def test_key_lists_each_switch_of_the_subjects() -> None:
    assert {switch for subject, switch in KEY if subject == "arm"} == set(DEFECTS)
    for subject, source in {
        "closed_loop": "arm/closed_loop.py",
        "two_arms": "arm/two_arms.py",
        "firmware": "firmware/firmware.c",
        "c_client": "client/client.c",
        "client": "client/plain.py",
    }.items():
        text = (HERE / source).read_text("utf-8")
        for switch in (switch for of, switch in KEY if of == subject):
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


DEFECT = Defect("arm", "x", "it is wrong", ("get_angles",), ("LEN", "0F"))


@pytest.mark.parametrize(
    ("command", "text", "named"),
    [
        ("get_angles", "expected LEN 0E; came 0F", True),
        ("stop", "after get_angles: LEN is 0F", True),
        ("stop", "LEN is 0F", False),
        ("get_angles", "expected LEN 0E", False),
    ],
)
def test_message_names_a_cause_by_command_and_every_word(
    command: str, text: str, named: bool
) -> None:
    message = Message("reply-frame", command, text)
    assert verdict_on(DEFECT, [message]).named == (message if named else None)


def test_listing_counts_and_shows_each_defect() -> None:
    message = Message("reply-frame", "get_angles", "LEN is 0F")
    verdicts = [
        verdict_on(DEFECT, [Message("state-kept", "stop", "it moved"), message]),
        verdict_on(DEFECT._replace(words=("x",)), [message]),
        verdict_on(DEFECT, []),
    ]
    _, arm, every = figures(verdicts, {"arm": [message]})
    assert arm.split("  ")[0] == SUBJECTS["arm"]
    assert arm.split()[-5:] == ["3", "2", "1", "1", "failures"]
    assert every.split() == ["all", "3", "2", "1"]
    assert list(map(line, verdicts)) == [
        "named  arm x: it is wrong\n       reply-frame get_angles: LEN is 0F (+1)",
        "found  arm x: it is wrong\n       reply-frame get_angles: LEN is 0F",
        "MISSED arm x: it is wrong",
    ]
