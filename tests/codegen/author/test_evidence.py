"""``cobotwire-gen evidence`` checks the files that owners send and records what they confirm."""

from __future__ import annotations

import io
import json
import zipfile
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import vectors
from cobotwire.capture.packet import Interface, Packet
from cobotwire.capture.writer import CaptureWriter
from cobotwire.conformance.survey import ASPECTS as SURVEYED
from cobotwire.conformance.survey.facts import Facts
from cobotwire.conformance.survey.file import survey_file
from cobotwire.editions import load
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.evidence import submitted as reading
from cobotwire_codegen.evidence.entry import checked, text_of
from cobotwire_codegen.evidence.submitted import MEMBERS, NotEvidence, submitted
from cobotwire_codegen.facts import (
    ASPECTS,
    Sources,
    bar,
    confirmed,
    counts,
    facts_of,
    unconfirmed,
)
from codegen.author import samples

BUS = build_edition(samples.FOLDER / "bus.yaml", samples.FOLDER)
LIT, DARK, ACK = "FE FE 01 03 01 01 02", "FE FE 01 03 01 00 01", "FE FE 01 02 01 01"
EVIL = '", verdict: confirmed}\n- !!python/object: <script>{{ 7*7 }}\\'


def fact(name: str, verdict: str, sent: str = DARK, received: str = ACK, why: str = "") -> Any:
    """Return a fact of the bus, as a survey states it."""
    frames = [{"sent": sent, "received": received}]
    return {"fact": f"bus/{name}", "verdict": verdict, "why": why, "frames": frames}


def survey(*facts: Any, **changed: Any) -> dict[str, Any]:
    """Return the JSON of a survey."""
    return {
        "format": "cobotwire-survey",
        "version": 1,
        "edition": "bus",
        "edition_digest": "",
        "robot": "My lamp",
        "simulated": False,
        "firmware": {"get_version": "1.3"},
        "date": "2026-11-25T10:00:00Z",
        "facts": list(facts),
    } | changed


def packed(data: Any, line: str = f"{LIT} {DARK} {ACK}", more: Any = None) -> bytes:
    """Return a survey with a recording of these bytes."""
    recording = io.BytesIO()
    writer = CaptureWriter(recording)
    arm = writer.interface(Interface("/dev/ttyACM0"))
    writer.packet(Packet(0, "received", bytes.fromhex(line), "bytes", interface=arm))
    writer.finish()
    text = data if isinstance(data, bytes) else json.dumps(data).encode()
    members = {"survey.json": text, "recording.pcapng": recording.getvalue()} | (more or {})
    with zipfile.ZipFile(file := io.BytesIO(), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return file.getvalue()


GOOD = packed(
    survey(
        fact("light/reply/id", "confirmed", LIT),
        fact("light/request.lit/range", "contradicted", why=f"It says {EVIL!r}"),
        fact("reset/command/present", "not seen"),
    )
)


def report(results: list[tuple[str, str, str]], **changed: Any) -> bytes:
    """Return the JSON of a conformance report with results: test case, command, verdict."""
    line = [("sent", LIT), ("received", ACK)]
    evidence = [
        {"at": 0.1, "direction": direction, "data": data, "note": ""} for direction, data in line
    ]
    rows = [
        {"case": c, "command": n, "verdict": v, "reason": "It was late.", "evidence": evidence}
        for c, n, v in results
    ]
    head = {"format": "cobotwire-conformance", "version": 4, "kind": "device", "edition": "bus"}
    about = {"subject": "/dev/ttyACM0", "started": "2026-11-25", "firmware": "", "options": {}}
    return json.dumps({**head, **about, "edition_digest": "", "results": rows, **changed}).encode()


def test_survey_adds_vectors_disputes_and_confidence(tmp_path: Path) -> None:
    folder = samples.copied(tmp_path)
    (folder / "survey.zip").write_bytes(GOOD)
    words = ("evidence", "add", "survey.zip", "--edition-file", "bus.yaml")
    dry = samples.run(folder, *words, "--dry-run")
    assert not (folder / "evidence").exists()
    done = samples.run(folder, *words)
    assert (done.returncode, done.stdout) == (0, dry.stdout)
    assert "not confirmed by any arm: 4 facts before, 3 now" in done.stdout
    assert "evidence-added: bus/evidence/" in done.stdout
    [path] = (folder / "evidence").iterdir()
    assert path.name.startswith("bus-2026-11-25-")
    edition = build_edition(folder / "bus.yaml", folder)
    assert edition.observed[1].source == (
        "a survey of a real arm, 2026-11-25: My lamp, firmware get_version 1.3"
    )
    about, derived = edition.by_name["light"].disputed
    assert (about.about, about.confidence) == ("reply/length", "medium")
    # Two lamps contradict it.
    assert (derived.about, derived.confidence) == ("request.lit/range", "low")
    assert EVIL.partition("\n")[0] in derived.evidence[-1].says
    again = samples.run(folder, *words)
    assert (again.returncode, "was added before: evidence/bus-2026" in again.stderr) == (2, True)


def test_new_frames_of_undisputed_commands_become_vectors() -> None:
    right = fact("light/request/length", "confirmed", LIT)
    wrong = fact("light/reply/length", "contradicted")
    given = submitted(packed(survey(right)))
    bare = replace(BUS, vectors=())
    lines = [vector[2:] for vector in checked(bare, given).vectors]
    assert lines == [
        ["  direction: request", f"  frame: {LIT}", "  values: {lit: true}"],
        ["  direction: reply", f"  frame: {ACK}"],
    ]
    assert checked(BUS, given).vectors == []  # the edition has these frames
    assert checked(bare, submitted(packed(survey(right, wrong)))).vectors == []


def test_sealed_file_is_accepted_and_a_changed_one_is_refused() -> None:
    with zipfile.ZipFile(io.BytesIO(GOOD)) as archive:
        document, recording = (archive.read(name) for name in MEMBERS)
    sealed = survey_file(json.loads(document), recording)
    assert submitted(sealed).facts == submitted(GOOD).facts
    with zipfile.ZipFile(io.BytesIO(sealed)) as archive:
        stated = json.loads(archive.read("survey.json"))
    for changed in (
        packed(stated | {"robot": "Your lamp"}, more={"recording.pcapng": recording}),
        packed(stated, more={"recording.pcapng": recording + recording}),
        report([], digest="00"),
    ):
        with pytest.raises(NotEvidence, match="was changed after it was written"):
            submitted(changed)


@pytest.mark.parametrize(
    ("wrong", "why"),
    [
        (fact("light/request/length", "confirmed", "FE FE 01 03 01 05 06"), "in the recording"),
        (fact("light/reply/length", "confirmed", LIT, LIT[:11]), "not frames of the command"),
        (fact("light/reply.lit/range", "confirmed"), "no such part"),
        (fact("dark/reply/length", "confirmed"), "no such part"),
        (fact("light/reply/length", "contradicted", "", ""), "no frame shows it"),
    ],
)
def test_fact_without_a_matching_frame_is_refused(wrong: Any, why: str) -> None:
    with pytest.raises(NotEvidence, match=why):
        checked(BUS, submitted(packed(survey(wrong))))


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (packed(survey(simulated=True)), "nothing in the survey shows that the arm is real"),
        (
            packed({k: v for k, v in survey().items() if k != "simulated"}),
            "nothing in the survey shows that the arm is real",
        ),
        (packed(survey(robot="a\x1b[2J")), "cannot be printed"),
        (packed(survey(robot="a" * 81)), "0 to 80 characters"),
        (packed(survey(edition="../../etc")), "is not a name"),
        (packed(survey(date="../2026-11-24")), "write it like"),
        (packed(survey({**fact("x", "confirmed"), "fact": "bus/a/../id"})), "not the name of a"),
        (packed(survey(*[fact("light/command/present", "confirmed")] * 2)), "is given twice"),
        (packed(survey(fact("light/command/present", "proven"))), "verdict of"),
        (packed(b'{"format": 1, "format": 1}'), "a key twice"),
        (packed(b"[" * 100_000), "not JSON"),
        (packed(survey(version=2)), "version 1"),
        (packed(survey(), more={"../x": b""}), "this file has"),
        (packed(b" " * (MEMBERS["survey.json"] + 1)), "more than 2 MB"),
        (packed(survey(), more={"recording.pcapng": b"\n\r\r\n"}), "not pcapng"),
        (b"PK", "not a whole zip"),
        (report([], subject="simulated arm in memory"), "about a program"),
        (report([], subject="socket://10.0.0.7:9000"), "a program at"),
        (report([], subject="/dev/pts/3"), "a program at"),
        (report([], version=1), "not a survey"),
    ],
)
def test_hostile_file_is_refused(data: bytes, why: str) -> None:
    with pytest.raises(NotEvidence, match=why):
        submitted(data)


def test_archive_with_two_members_of_one_name_is_refused() -> None:
    with zipfile.ZipFile(file := io.BytesIO(GOOD), "a") as archive:
        with pytest.warns(UserWarning, match="Duplicate"):
            archive.writestr("survey.json", "{}")
    with pytest.raises(NotEvidence, match="this file has"):
        submitted(file.getvalue())


@example(at=0, by=b"PK")
@given(at=st.integers(0, len(GOOD)), by=st.binary(max_size=20))
def test_changed_or_arbitrary_file_is_read_or_refused(at: int, by: bytes) -> None:
    for data in (GOOD[:at] + by + GOOD[at + len(by) :], GOOD[:at] + by, by):
        with suppress(NotEvidence):
            assert submitted(data).edition == "bus"


@given(st.recursive(st.none() | st.integers() | st.text(), st.lists, max_leaves=5), st.data())
def test_survey_of_any_values_gives_a_spec_or_is_refused(value: Any, data: st.DataObject) -> None:
    key = data.draw(st.sampled_from(sorted(survey())))
    inner = fact("light/request.lit/range", "contradicted")
    inner[data.draw(st.sampled_from(sorted(inner)))] = value
    line = reading.submitted(GOOD).line
    for changed in (survey(inner), survey(**{key: value})):
        try:
            given = reading._survey(changed, "ab" * 32)
            given.line = line
            text = text_of(given, checked(BUS, given))
        except NotEvidence:
            continue
        path = samples.FOLDER / "bus.yaml"
        new = {path.parent / "bus_evidence.yaml": text}
        assert build_edition(path, path.parent, new).observed[0].robot == given.robot


def test_report_of_a_device_gives_facts_of_its_test_cases() -> None:
    passed = [("reply-frame", "light", "pass"), ("effect", "reset", "not run")]
    failed = [("change-replied", "light", "fail"), ("recovers", "light", "pass")]
    found = {each.fact: each.confirmed for each in submitted(report(passed + failed)).facts}
    assert found == {
        "light/reply/id": True,
        "light/reply/length": True,
        "light/command/present": False,
        "light/command/deadline": False,
    }


@pytest.mark.parametrize("edition", vectors.sampled())
def test_survey_reports_the_facts_that_the_generator_counts(edition: str) -> None:
    described, table = vectors.edition(edition), load(edition).TABLE
    # A survey also reports aliases, which are not counted.
    others = {command.name for command in described.commands if not command.alias}
    reported = {name for name in Facts(table) if name.split("/")[1] in others}
    counted = {*facts_of(described)}
    assert reported <= counted
    left = {name.split("/", 2)[2] for name in counted - reported}
    # A survey cannot report these aspects, nor a range that equals all that the bytes can hold.
    beyond = {"command/present", "command/agreement", "request/length", "reply/length", "reply/id"}
    assert {each for each in left - beyond if not each.endswith("/range")} == set()
    assert {*ASPECTS} == {*SURVEYED}


def test_facts_are_counted_by_source_and_listed_until_an_arm_confirms_them(tmp_path: Path) -> None:
    found = confirmed(BUS, Sources(frozenset({"reset"})))
    assert facts_of(BUS).keys() == found.keys()
    assert found["bus/light/command/present"] == {"survey"}
    assert found["bus/light/request.lit/range"] == frozenset()
    assert found["bus/reset/command/present"] == {"library"}
    assert counts(found)["unconfirmed"] == len(unconfirmed(found)) == len(found) - 3
    assert counts(found)["none"] == list(found.values()).count(frozenset())
    folder = samples.copied(tmp_path)
    shown = samples.run(folder, "evidence", "list", "--edition-file", "bus.yaml")
    assert "  light (3): request.lit: range; reply.done: range; reply: id" in shown.stdout
    plain = samples.run(folder, "evidence", "list", "--edition-file", "bus.yaml", "--json")
    assert json.loads(plain.stdout)["bus"]["facts"]["bus/light/command/present"] == ["survey"]
    assert [bar(part, 900) for part in (0, 1, 900)] == [
        *("░░░░░░░░░░ 0 %", "░░░░░░░░░░ <1 %", "██████████ 100 %")
    ]
