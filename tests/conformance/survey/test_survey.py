"""A survey names the fault of a wrong arm, and contradicts nothing on a correct one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import small_specs
from cobotwire import editions
from cobotwire.conformance.survey import Survey
from cobotwire.conformance.survey.facts import Fact, Frames
from cobotwire.conformance.survey.file import continued
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Command, Number, Table
from targets.specs import edition_of
from vectors import sampled
from wrong_arms import POSE, WRONG_ARMS, WrongArm, connected, with_command, with_numbers

SMALL = editions.load("mycobot280").TABLE


def survey_of(
    edition: str, wrong: WrongArm | None = None, *, settings: bool = False, motion: bool = False
) -> Survey:
    table = editions.load(edition).TABLE
    connection = connected(table, wrong=wrong, at=() if motion else POSE)
    survey = Survey(connection, table, settings=settings, motion=motion)
    survey.run()
    return survey


@pytest.mark.parametrize("edition", sampled())
def test_survey_of_a_correct_arm_contradicts_nothing(edition: str) -> None:
    survey = survey_of(edition, settings=True, motion=True)
    assert survey.finished
    assert survey.contradicted == []
    confirmed = {fact.fact.rpartition("/")[2] for fact in survey.facts.with_verdict("confirmed")}
    assert confirmed >= {"present", "deadline", "id", "length", "effect"}


def test_motion_confirms_scale_sign_and_order_of_angles() -> None:
    facts = survey_of("mycobot280", motion=True).facts
    for aspect in ("scale", "sign", "order", "byte-order", "agreement"):
        assert facts[f"mycobot280/get_angles/reply.angles/{aspect}"].verdict == "confirmed", aspect
    # Without motion all angles stay 0, which is right in every scale.
    at_rest = Survey(connected(SMALL), SMALL)
    at_rest.run()
    assert at_rest.facts["mycobot280/get_angles/reply.angles/scale"].verdict == "not seen"


@pytest.mark.parametrize("wrong", WRONG_ARMS, ids=lambda wrong: wrong.name)
def test_survey_names_what_is_wrong_with_an_arm(wrong: WrongArm) -> None:
    survey = survey_of(wrong.edition, wrong, settings=wrong.level > 1)
    if not wrong.fact:
        assert survey.other
        assert wrong.words in survey.obstacle
        return
    fact = survey.facts[f"{wrong.edition}/{wrong.fact}"]
    assert wrong.words in fact.why
    # An arm may lack a gripper: that contradicts nothing.
    assert fact.verdict == ("not seen" if wrong.name == "gripper id" else "contradicted")
    assert fact.frames
    # The only other contradicted facts are the same aspect of similar commands.
    others = {f.fact for f in survey.facts.with_verdict("contradicted")} - {fact.fact}
    aspect = fact.fact.rpartition("/")[2]
    assert all(other.endswith(aspect) for other in others)
    assert len(others) <= 3


def tenths(number: Number) -> Number:
    """Return an angle that is sent in tenths of a degree."""
    if (number.unit, number.divide) != ("degree", 100) or number.name.startswith("r"):
        return number
    ends = number.minimum // 10, number.maximum // 10
    return number._replace(divide=10, minimum=ends[0], maximum=ends[1])


def in_tenths(*names: str) -> WrongArm:
    """Return an arm that sends and receives the angles of commands in tenths; no names: of all."""

    def change(table: Table) -> Table:
        chosen = (c.name in names or not names for c in table.commands)
        every = zip(table.commands, chosen)
        return table._replace(commands=tuple(with_numbers(c, tenths) if y else c for c, y in every))

    return WrongArm("", "", "", change)


def test_wrong_scale_of_all_angles_shows_by_encoders_after_the_first_motion() -> None:
    survey = survey_of("mycobot280", in_tenths(), motion=True)
    assert "no further motion" in survey.obstacle
    assert "tenths" in survey.facts["mycobot280/get_angles/reply.angles/scale"].why


def test_arm_that_goes_further_than_sent_is_stopped() -> None:
    survey = survey_of("mycobot280", in_tenths("send_angles"), motion=True)
    assert "the arm went much further than" in survey.obstacle
    [why] = [why for why in survey.contradicted if "send_angles/command/effect" in why]
    assert "was stopped" in why


@pytest.mark.parametrize("name", ["feetech", "ublox"])
def test_survey_of_a_users_protocol_contradicts_nothing(name: str, tmp_path: Path) -> None:
    table = small_specs.package(tmp_path, edition_of(name)).TABLE
    survey = Survey(connected(table), table, settings=True, motion=True)
    survey.run()
    assert survey.contradicted == []
    assert survey.facts.with_verdict("confirmed")


def test_survey_of_an_arm_that_falls_silent_ends_and_keeps_what_it_found() -> None:
    connection, sent = connected(SMALL), 0
    write = connection.transport.write

    def write_until_silent(data: bytes) -> None:
        nonlocal sent
        sent += 1
        if sent < 20:
            write(data)

    connection.transport.write = write_until_silent  # type: ignore[method-assign]
    survey = Survey(connection, SMALL, motion=True)
    survey.run()
    assert "the device does not reply" in survey.obstacle
    assert not survey.finished
    assert survey.facts.with_verdict("confirmed")


def test_replies_that_identify_a_device_are_hashed_and_not_kept_as_evidence() -> None:
    def renamed(command: Command) -> Command:
        [variant] = command.reply
        fields = tuple(field._replace(name="serial") for field in variant.fields)
        return command._replace(reply=(variant._replace(fields=fields),), package="")

    table, hidden = with_command(SMALL, "get_reboot_count", renamed), list[bool]()
    survey = Survey(connected(SMALL), table, on_private=hidden.append)
    survey.run()
    assert survey.hashed == ["get_reboot_count"]
    assert hidden.count(True) == 1
    fact = survey.facts["mycobot280/get_reboot_count/command/present"]
    assert (fact.verdict, fact.frames) == ("confirmed", ())


def test_angle_beyond_a_limit_contradicts_the_limit_but_no_sign() -> None:
    table = editions.load("mypalletizer260").TABLE
    survey = Survey(connected(table, at=(10.0, 20.0, 95.0, -9.0)), table)
    survey.run()
    wrong = {fact.fact.rpartition("/")[2] for fact in survey.facts.with_verdict("contradicted")}
    assert wrong == {"limits"}


def test_continued_survey_keeps_a_fact_that_only_the_earlier_one_could_decide() -> None:
    late = {"fact": "mycobot280/set_fresh_mode/command/deadline", "verdict": "contradicted"}
    unseen = {"fact": "mycobot280/set_fresh_mode/reply/id", "verdict": "not seen"}
    content = {"facts": [unseen], "hashed": [], "level": 2}
    merged, _ = continued(({"facts": [unseen, late], "level": 2}, b""), content, b"")
    assert merged["facts"] == [unseen, late]


def test_long_evidence_of_a_fact_is_hex_that_a_reader_of_the_file_accepts() -> None:
    fact: Any = Fact("a/b/command/present", frames=(Frames(bytes(60), bytes(2000)),)).as_json()
    assert [len(bytes.fromhex(fact["frames"][0][k])) for k in ("sent", "received")] == [60, 300]


def test_query_without_replies_at_one_address_contradicts_no_effect() -> None:
    table = editions.load("mybuddy").TABLE
    survey = Survey(connected(table), table, address="left")
    survey.run()
    assert survey.contradicted == []


def test_refusal_of_a_default_address_without_replies_names_the_option() -> None:
    table = editions.load("mybuddy").TABLE
    silent = table.addresses[0]._replace(replies="none")
    with pytest.raises(UsageError, match=r"'ALL'; allowed: .* \(--address\)"):
        Survey(connected(table), table._replace(addresses=(silent, *table.addresses[1:])))
