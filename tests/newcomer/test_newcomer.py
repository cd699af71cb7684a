"""Install both wheels in a fresh environment without Rust, and use a custom protocol."""

from __future__ import annotations

import subprocess
import zipfile
from pathlib import Path

import pytest

import vectors
from cobotwire.studio.extras import CURVES
from newcomer.installing import run

PROTOCOL = """\
edition: heater
class: Heater
title: A heater
doc: A heater with two plates.
joints: 0
frame:
  frame:
    header: FE FE
    check: crc16-modbus
    length_counts: [command, data, check]
    maximum_data: 8
    doc: The maker's second frame format.
  transport: {baudrate: 115200, deadline_ms: 200}
types:
  wire:
    byte: {bytes: 1, doc: A byte.}
    word: {bytes: 2, signed_at: 32767, doc: A signed word.}
  quantities:
    plate: {wire: byte, range: [1, 2], doc: The plate.}
    warmth: {wire: word, scale: 1/10, unit: degree_celsius, range: [0, 250], doc: The warmth.}
  flags:
    flag: {wire: byte, doc: Yes or no.}
commands:
  set_warmth:
    id: 0x10
    title: Set the warmth
    doc: Sets the warmth of a plate.
    safety: setting
    request: [{name: plate, type: plate}, {name: warmth, type: warmth}]
  get_warmth:
    id: 0x11
    title: Read the warmth
    doc: Reads the warmth of a plate.
    safety: query
    request: [{name: plate, type: plate}]
    reply: [{name: plate, type: plate, echo: required}, {name: warmth, type: warmth}]
  is_hot:
    id: 0x12
    title: Read whether a plate is hot
    doc: Reads whether any plate is hot.
    safety: query
    reply: [{name: hot, type: flag}]
"""

SCRIPT = """\
from cobotwire.simulator import PtyServer, SimulatedArm
from heater import TABLE, Heater

with PtyServer(SimulatedArm(TABLE)) as server, Heater(server.url) as heater:
    heater.set_warmth(2, 23.5)
    print(heater.codec, heater.get_warmth(2), heater.is_hot())
    try:
        heater.set_warmth(3, 20)
    except ValueError as error:
        print(error)
"""


def test_package_built_from_one_yaml_file_talks_to_its_simulator(
    tmp_path: Path, fresh: Path, environment: dict[str, str]
) -> None:
    (tmp_path / "heater.yaml").write_text(PROTOCOL + _vectors())
    build = run(
        "cobotwire-gen", "build", "heater.yaml", "--out", "heater", cwd=tmp_path, env=environment
    )
    assert "heater (3 commands)" in build.stdout
    (tmp_path / "try_it.py").write_text(SCRIPT)
    tried = run(fresh / "python", "try_it.py", cwd=tmp_path, env=environment)
    assert tried.stdout.splitlines() == [
        "native 0.0 False",
        "plate is 3; allowed: a whole number 1..2",
    ]
    listed = run("cobotwire", "--edition", "heater", "commands", cwd=tmp_path, env=environment)
    assert "0x11  get_warmth" in listed.stdout
    decoded = run(
        *("cobotwire", "--edition", "./heater", "decode", _frame(0x11, "02")),
        cwd=tmp_path,
        env=environment,
    )
    assert "request: get_warmth(plate=2)" in decoded.stdout
    with pytest.raises(FileNotFoundError):
        run("cargo", "--version", env={**environment, "PATH": str(fresh)})


@pytest.mark.skipif(not CURVES.is_file(), reason="uPlot is missing: run `make front-end`")
def test_wheel_ships_the_page_of_the_studio_with_its_library(wheels: list[Path]) -> None:
    [native] = [wheel for wheel in wheels if wheel.name.startswith("cobotwire-")]
    folder = "cobotwire/studio/page/"
    page = {name.removeprefix(folder) for name in zipfile.ZipFile(native).namelist()}
    assert {"index.html", "main.js", "vendor/uPlot.esm.js", "vendor/LICENSE-uPlot"} <= page


def test_delta_of_an_edition_that_the_package_ships_needs_no_clone(
    tmp_path: Path, environment: dict[str, str]
) -> None:
    text = "edition: mine\nclass: Mine\ntitle: Mine\ndoc: Mine.\nbase: cobotwire:mycobot280\n"
    (tmp_path / "mine.yaml").write_text(text)
    built = run("cobotwire-gen", "build", "mine.yaml", "--out", "m", cwd=tmp_path, env=environment)
    commands = len(vectors.edition("mycobot280").commands)
    assert f"mine ({commands} commands)" in built.stdout


def test_command_line_works_without_extras_and_names_a_missing_one(
    environment: dict[str, str],
) -> None:
    assert "get_angles" in run("cobotwire", "commands", env=environment).stdout
    assert "late-replies" in run("cobotwire", "sim", "--list-scenarios", env=environment).stdout
    with pytest.raises(subprocess.CalledProcessError) as caught:
        run("cobotwire", "plot", "arm.pcapng", "-o", "arm.svg", env=environment)
    sentence = "plotting needs matplotlib: pip install 'cobotwire[plot]'"
    assert caught.value.stderr == f"cobotwire: {sentence}\n"


def test_own_template_replaces_the_shipped_one_of_the_same_name(
    tmp_path: Path, environment: dict[str, str]
) -> None:
    (tmp_path / "heater.yaml").write_text(PROTOCOL + _vectors())
    own = tmp_path / "templates" / "python"
    own.mkdir(parents=True)
    template = '"""{{ edition.types | select("enum") | list | length }} enums of our own."""\n'
    (own / "enums.py.j2").write_text(template)
    words = ("build", "heater.yaml", "--out", "heater", "--templates", "templates")
    run("cobotwire-gen", *words, cwd=tmp_path, env=environment)
    assert (tmp_path / "heater" / "enums.py").read_text() == '"""0 enums of our own."""\n'


def test_build_into_folder_with_other_files_fails_and_changes_nothing(
    tmp_path: Path, environment: dict[str, str]
) -> None:
    (tmp_path / "heater.yaml").write_text(PROTOCOL + _vectors())
    (tmp_path / "heater").mkdir()
    (tmp_path / "heater" / "thesis.py").write_text("# years of work\n")
    words = ("build", "heater.yaml", "--out", "heater")
    with pytest.raises(subprocess.CalledProcessError) as caught:
        run("cobotwire-gen", *words, cwd=tmp_path, env=environment)
    assert "the folder contains files that were not generated" in caught.value.stderr
    assert (tmp_path / "heater" / "thesis.py").read_text() == "# years of work\n"


def _frame(command: int, data: str) -> str:
    """Return a frame with its CRC, computed here independently of the code under test."""
    body = bytes.fromhex(f"FEFE{3 + len(data) // 2:02X}{command:02X}{data}")
    crc = 0xFFFF
    for byte in body:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ 0xA001 if crc & 1 else crc >> 1
    return (body + crc.to_bytes(2, "big")).hex(" ").upper()


def _vectors() -> str:
    rows = [
        ("set", "set_warmth", "request", _frame(0x10, "0200EB"), "{plate: 2, warmth: 23.5}"),
        ("get", "get_warmth", "request", _frame(0x11, "02"), "{plate: 2}"),
        ("warmth", "get_warmth", "reply", _frame(0x11, "0200EB"), "{plate: 2, warmth: 23.5}"),
        ("get hot", "is_hot", "request", _frame(0x12, ""), "{}"),
        ("hot", "is_hot", "reply", _frame(0x12, "01"), "{hot: true}"),
    ]
    lines = [
        f'  - {{name: "{name}", command: {command}, direction: {way}, '
        f"frame: {frame}, values: {values}}}\n"
        for name, command, way, frame, values in rows
    ]
    return "vectors:\n" + "".join(lines)
