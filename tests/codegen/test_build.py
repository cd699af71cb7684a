"""``cobotwire-gen build`` reports a user's mistake in one line and overwrites nothing."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.render import render_reference
from codegen.author.samples import run

LAMP = (Path(__file__).parent / "lamp.yaml").read_text()
OWN = """\
{edition: own, class: Own, title: Own, doc: Own., base: "cobotwire:mycobot", types: ../more.yaml,
commands: {
 blink: {id: 0x72, title: Blink, doc: Reads., safety: query, reply: [{name: rate, type: rate}]}},
vectors: [{name: request, command: blink, direction: request, frame: FE FE 02 72 FA},
 {name: reply, command: blink, direction: reply, frame: FE FE 03 72 07 FA, values: {rate: 7}}]}
"""
MORE = "{quantities: {rate: {wire: byte, doc: How often.}}}\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "lamp.yaml").write_text(LAMP)
    return tmp_path


def test_build_writes_package_reference_and_c_and_finds_them_fresh(folder: Path) -> None:
    words = ("build", "lamp.yaml", "--out", "lamp", "--docs", "docs", "--c", "c", "--rust", "rs")
    assert run(folder, *words).returncode == 0
    assert sorted(path.name for path in (folder / "rs").iterdir()) == ["lamp.json", "lamp.rs"]
    assert (folder / "lamp" / "py.typed").is_file()
    assert sorted(path.name for path in (folder / "c").iterdir()) == ["lamp.c", "lamp.h"]
    again = run(folder, *words, "--check")
    assert (again.returncode, again.stdout) == (0, "fresh\n")


def test_reference_names_the_device_and_the_check_of_its_frames(folder: Path) -> None:
    framed = LAMP.replace("length_counts: [", "check: crc16-modbus\n    length_counts: [check, ")
    (folder / "lamp.yaml").write_text(framed)
    edition = replace(build_edition(folder / "lamp.yaml", folder), title="A lamp: with a check")
    pages = {str(path): text for path, text in render_reference(edition).items()}
    assert "# Protocol of the lamp\n" in pages["README.md"]
    check = "The check of each frame is crc16-modbus over all bytes before it, high byte first."
    assert check in pages["README.md"]


def test_build_writes_plugins_into_folder_with_other_files(folder: Path) -> None:
    (folder / "plugins").mkdir()
    (folder / "plugins" / "other.lua").write_text("of somebody else\n")
    words = ("build", "lamp.yaml", "--out", "lamp", "--wireshark", "plugins")
    assert run(folder, *words).returncode == 0
    assert sorted(path.name for path in (folder / "plugins").iterdir()) == ["lamp.lua", "other.lua"]
    assert run(folder, *words, "--check").returncode == 0


def test_output_is_the_same_in_every_folder(tmp_path: Path) -> None:
    outputs = []
    for folder, start in (("one", "."), ("another/inside", "spec/own")):
        own = tmp_path / folder / "spec" / "own"
        own.mkdir(parents=True)
        (own / "own.yaml").write_text(OWN)
        (own.parent / "more.yaml").write_text(MORE)
        at = own.relative_to(tmp_path / folder / start).as_posix()
        options = (
            f"--{name}={at}/{name}" for name in ("out", "docs", "c", "rust", "wireshark", "vectors")
        )
        ended = run(tmp_path / folder / start, "build", f"{at}/own.yaml", *options)
        assert ended.returncode == 0, ended.stderr
        run(tmp_path / folder / start, "model", f"{at}/own.yaml", "--out", f"{at}/model.json")
        files = (path for path in own.rglob("*") if path.is_file())
        outputs.append({str(path.relative_to(own)): path.read_bytes() for path in files})
    first, second = outputs
    assert len(first) > 40
    assert {name for name in first if first[name] != second.get(name)} == set()
    assert {"vectors/own.json", "vectors/schema.json"} < {*first}
    assert [name for name, data in first.items() if str(tmp_path).encode() in data] == []
    places = {
        each["name"]: each["place"] for each in json.loads(first["out/edition.json"])["commands"]
    }
    assert places["blink"] == "own.yaml:3"
    assert places["get_angles"] == "spec/commands/motion.yaml:19"
    assert b'"place": "../more.yaml:1:15"' in first["model.json"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--out", "o", "--docs", "o"), "must be separate folders"),
        (("--out", "o", "--docs", "o/docs"), "must be separate folders"),
        (("--out", "o/inner", "--docs", "o"), "must be separate folders"),
        (("--out", "o", "--docs", "d", "--c", "d"), "--docs and --c must be separate folders"),
        (("--out", "o", "--wireshark", "o/w"), "must be separate folders"),
        (("--out", "my-pkg"), "my-pkg is not a valid package name"),
        (("--out", "class"), "class is not a valid package name"),
        (("--out", "cobotwire"), "cobotwire is not a valid package name"),
        (("--out", "lamp.yaml/x"), "cannot write"),
    ],
)
def test_build_rejects_invalid_folders(folder: Path, words: tuple[str, ...], message: str) -> None:
    result = run(folder, "build", "lamp.yaml", *words)
    assert result.returncode == 2
    assert message in result.stderr
    assert "Traceback" not in result.stderr
    assert sorted(path.name for path in folder.iterdir()) == ["lamp.yaml"]


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("python/enums.py.j2", "{% bad %}", "enums.py.j2:1: Encountered unknown tag 'bad'"),
        (
            "python/enums.py.j2",
            "\n{{ nope }}",
            "enums.py.j2:2: UndefinedError: 'nope' is undefined",
        ),
        ("python/enums.py.j2", "{{ 1 // 0 }}", "enums.py.j2:1: ZeroDivisionError"),
        ("python/enums.py.j2", "{{ ''.__class__.__mro__ }}", "SecurityError: access to attribute"),
        (
            "python/enum.py.j2",
            "",
            "no template python/enum.py.j2; did you mean python/enums.py.j2?",
        ),
    ],
)
def test_mistake_in_a_users_template_is_reported_with_its_place(
    folder: Path, name: str, text: str, message: str
) -> None:
    path = folder / "templates" / name
    path.parent.mkdir(parents=True)
    path.write_text(text)
    words = ("build", "lamp.yaml", "--out", "lamp", "--templates", "templates")
    result = run(folder, *words)
    assert result.returncode == 2
    assert message in result.stderr
    assert not (folder / "lamp").exists()


def test_model_reports_an_unwritable_file_in_one_line(folder: Path) -> None:
    result = run(folder, "model", "lamp.yaml", "--out", "nowhere/lamp.json")
    assert result.returncode == 2
    assert "cannot write nowhere/lamp.json: No such file" in result.stderr
