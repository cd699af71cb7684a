"""Run the verbs of ``cobotwire conform``; check output, files and exit codes."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

import in_process
import vectors
from cobotwire.cli.app import app
from cobotwire.conformance.reports import from_json
from cobotwire.editions.mycobot280 import MyCobot280
from command_line import printed, run_program, started
from in_process import Ended

CLIENT = ("--edition", "mycobot280", "conform", "client")
ADAPTER = [sys.executable, "-m", "cobotwire.conformance.codec.adapter"]


def _run(*words: str, edition: str = "mycobot280") -> Ended:
    words = ("--edition", edition, "conform", *words)
    return in_process.run(app, "cobotwire", *words, folder=vectors.ROOT)


# The calls of a script, the exit code, and what the output names.
SCRIPTS = [
    ("pty", "get_angles\nsend_angle 1 2.55 speed=50\n", 0, "pass"),
    ("socket://127.0.0.1:0", "get_angles\nsend_angle 1 2.5 speed=50\n", 1, "sent-value"),
]


def test_motion_needs_a_highest_speed_and_a_workspace() -> None:
    refused = _run("device", "--simulated", "--allow", "motion")
    assert refused.returncode == 2
    assert "max_speed" in refused.stderr


@pytest.mark.parametrize(("listen", "calls", "expected", "word"), SCRIPTS)
def test_client_is_compared_with_its_script(
    listen: str, calls: str, expected: int, word: str, tmp_path: Path
) -> None:
    file, script = tmp_path / "report.json", tmp_path / "calls.txt"
    script.write_text(calls)
    words = ("--expect", str(script), "--idle", "1", "--json", str(file))
    with started(*CLIENT, "--listen", listen, *words) as tester:
        with MyCobot280(printed(tester).strip()) as arm:
            assert arm.get_angles() is not None
            arm.send_angle(1, 2.55, 50)
        output, _ = tester.communicate(timeout=60)
    assert (tester.returncode, word in output) == (expected, True), output
    report = from_json(file.read_text())
    assert (report.kind, report.conforms) == ("client", expected == 0)


def test_known_failures_of_pymycobot_are_excused() -> None:
    known = vectors.ROOT / "tests" / "peers" / "pymycobot-codec.txt"
    done = _run(
        "codec", "--only", "*/send_angle/*", "--expected", str(known), "--", *ADAPTER, "pymycobot"
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "not supported" in done.stdout


@pytest.mark.parametrize(
    "words",
    [
        ["device", "/dev/no-such-port"],
        ["device", "socket://127.0.0.1:1"],
        ["device"],
        ["client", "--listen", "nowhere"],
        ["client", "--expect", "no-such-file"],
        ["codec", "--", "/no/such/command"],
        ["codec", "--", "false"],
        ["codec", "--expected", "no-such-file", "--", "true"],
        ["compare", "no-such-file", "nor-this"],
    ],
    ids=" ".join,
)
def test_run_that_cannot_start_ends_with_2_and_a_sentence(words: list[str]) -> None:
    done = _run(*words)
    assert done.returncode == 2
    assert done.stderr.strip()
    assert "Traceback" not in done.stderr


def test_cases_of_all_three_subjects_are_listed() -> None:
    found = json.loads(_run("cases", "--json").stdout)["cases"]
    assert found["device"]["reply-once"]
    assert found["client"]["motion-resent"]
    assert found["codec"]["stream-frames"]
    listed = _run("cases").stdout
    assert all(f"  {id} " in listed for cases in found.values() for id in cases)


@pytest.mark.parametrize(("host", "warns"), [("0.0.0.0", True), ("127.0.0.1", False)])
def test_client_tester_on_a_public_address_warns(host: str, warns: bool) -> None:
    words = ("client", "--listen", f"socket://{host}:0", "--seconds", "0.1")
    ended = _run(*words)
    warning = f"cobotwire: anyone who can reach {host} can connect, and is checked as the client\n"
    assert ended.stderr == (warning if warns else "")
    assert ended.returncode == 2
    assert ended.stdout.endswith("\nThe run is incomplete: the client sent no request.\n")


def test_interrupted_run_is_resumed_and_a_run_is_repeated_from_its_report(tmp_path: Path) -> None:
    first, second, third = (str(tmp_path / f"{name}.json") for name in ("first", "second", "third"))
    options = ("--allow", "setting", "--retries", "1")
    assert _run("device", "--simulated", *options, "--json", first).returncode == 0
    report = json.loads(Path(first).read_text())
    assert report["options"] == {"allow": "setting", "retries": "1"}
    # The report of a run that ended before the settings.
    settings = [r for r in report["results"] if r["group"] == "settings"]
    for result in settings:
        result |= {"cause": "run ended", "verdict": "not run"}
    report |= {"finished": False, "stopped": "the run was interrupted"}
    del report["digest"]
    Path(second).write_text(json.dumps(report))
    ended = _run("device", "--simulated", "--resume", second, "--json", third)
    assert ended.returncode == 0, ended.stdout
    resumed, again = (from_json(Path(name).read_text()) for name in (third, first))
    order = [(r.group, r.case, r.command, r.verdict) for r in again.results]
    assert [(r.group, r.case, r.command, r.verdict) for r in resumed.results] == order
    assert _run("device", "--simulated", "--again", third, "--json", first).returncode == 0
    repeated = from_json(Path(first).read_text())
    assert [(r.group, r.case, r.command, r.verdict) for r in repeated.results] == order
    assert repeated.options == again.options


def test_options_beside_those_of_a_report_are_a_usage_error(tmp_path: Path) -> None:
    file = tmp_path / "report.json"
    assert _run("device", "--simulated", "--json", str(file)).returncode == 0
    refused = _run("device", "--simulated", "--resume", str(file), "--allow", "setting")
    assert refused.returncode == 2
    assert "omit --allow" in refused.stderr
    both = _run("device", "--simulated", "--resume", str(file), "--again", str(file))
    assert (both.returncode, "not both" in both.stderr) == (2, True)


def test_simulated_arm_of_unknown_geometry_conforms_without_coordinates() -> None:
    ended = _run("device", "--simulated", edition="mypalletizer260")
    assert ended.returncode == 0, ended.stdout


def test_statement_of_an_edition_is_printed_and_selects_test_cases(tmp_path: Path) -> None:
    printed = _run("statement", edition="mycobot")
    assert printed.returncode == 0
    assert "edition: mycobot\n" in printed.stdout
    path, report = tmp_path / "arm.yaml", tmp_path / "report.json"
    text = _run("statement").stdout
    path.write_text(text.replace("get_tof_distance: implemented", "get_tof_distance: absent"))
    ended = _run("device", "--simulated", "--statement", str(path), "--json", str(report))
    assert ended.returncode == 1
    assert "get_tof_distance is declared absent" in ended.stdout
    # The report has the statement: the file is not needed to repeat the run.
    path.unlink()
    again = _run("device", "--simulated", "--again", str(report))
    assert again.returncode == 1
    assert again.stdout == ended.stdout


def test_mistake_in_a_statement_ends_with_2_before_anything_is_sent(tmp_path: Path) -> None:
    path = tmp_path / "arm.yaml"
    path.write_text("statement: 1\nedition: mycobot280\ncommands: {get_angels: absent}\n")
    ended = _run("device", "--simulated", "--statement", str(path))
    assert ended.returncode == 2
    assert f"{path}:3:12: commands has no key get_angels; did you mean get_angles?" in ended.stderr


def test_run_on_a_codec_is_repeated_from_its_report(tmp_path: Path) -> None:
    first, second = tmp_path / "first.json", tmp_path / "second.json"
    words = ("--only", "encode-bytes/get_encoder/*", "--json", str(first), "--", *ADAPTER, "native")
    assert _run("codec", *words, edition="mycobot").returncode == 0
    # The report has no path of the machine, so the command is found by its name, or given again.
    program = from_json(first.read_text()).options["command"].split()[0]
    assert Path(program).name.startswith("python")
    assert not Path(program).is_absolute()
    again = ("codec", "--again", str(first), "--json", str(second), "--", *ADAPTER, "native")
    assert _run(*again, edition="mycobot").returncode == 0
    one, other = (from_json(path.read_text()) for path in (first, second))
    assert [(r.case, r.command, r.outcome) for r in one.results] == [
        (r.case, r.command, r.outcome) for r in other.results
    ]
    assert one.options == other.options
    assert one.edition_digest == other.edition_digest != ""


@pytest.mark.parametrize("code", [0, 3])
def test_client_that_is_started_ends_the_run_when_it_ends(code: int, tmp_path: Path) -> None:
    script, file = tmp_path / "client.py", tmp_path / "report.json"
    script.write_text(
        "import sys\nfrom cobotwire import MyCobot280\n"
        f"with MyCobot280(sys.argv[1]) as arm:\n    arm.get_angles()\nsys.exit({code})\n"
    )
    command = f"{sys.executable} {script} {{port}}"
    done = run_program(*CLIENT, "--command", command, "--json", file)
    report = from_json(file.read_text())
    assert report.failures == []
    assert report.finished is (code == 0)
    assert done.returncode == (2 if code else 0)
    assert ("ended with code 3" in report.stopped) is (code == 3)
