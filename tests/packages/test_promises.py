"""Compare two source trees, as a release is compared with the last one."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import promises
from cobotwire import capture
from release import RECORDED, Failed
from vectors import ROOT

PAGE = "| **Python API** | every name of `cobotwire` and `cobotwire.part` | |\n"
PACKAGE = {
    "docs/compatibility.md": PAGE,
    "docs/api/part.md": ".. autoclass:: cobotwire.inner.Named\n   :members:\n",
    "python/cobotwire/__init__.py": "from cobotwire.inner import turn_to as turn_to\n",
    "python/cobotwire/part.py": (
        "from cobotwire.inner import *\n\ndef go(speed=1): ...\n\ndef _hidden(): ...\n"
    ),
    "python/cobotwire/inner.py": (
        "class Base:\n    def stop(self): ...\n\nclass Named(Base):\n    def start(self): ...\n\n"
        "def thing(angle): ...\n\ndef turn_to(): ...\n\ndef inside(): ...\n\n"
        "__all__ = ['Named', 'thing', 'turn_to']\n"
    ),
    "python/cobotwire/editions/__init__.py": "",
    "python/cobotwire/editions/lamp/__init__.py": "def light(): ...\n",
}
LAMP = ROOT / "examples/own_protocol/lamp.yaml"


def tree(folder: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return folder


def test_changes_of_the_api_are_found_if_a_page_promises_the_name(tmp_path: Path) -> None:
    changed = dict(PACKAGE)
    for file, old, new in [
        ("part.py", "go(speed=1)", "go(speed)"),
        ("part.py", "_hidden", "_gone"),
        ("inner.py", "def inside", "def outside"),
        ("inner.py", "def stop", "def halt"),
        ("inner.py", "angle", "turn"),
        ("__init__.py", "as turn_to", "as move_to"),
        ("editions/lamp/__init__.py", "light", "shine"),
    ]:
        name = f"python/cobotwire/{file}"
        changed[name] = changed[name].replace(old, new)
    before, after = tree(tmp_path / "old", PACKAGE), tree(tmp_path / "new", changed)
    assert {f"{one.rule} {one.where}" for one in promises.python_api(before, after)} == {
        "parameter-changed-required cobotwire.part.go(speed)",
        "object-removed cobotwire.inner.Named.stop",
        "object-added cobotwire.inner.Named.halt",
        "parameter-removed cobotwire.inner.thing(angle)",
        "parameter-added-required cobotwire.inner.thing(turn)",
        "object-removed cobotwire.turn_to",
        "object-removed cobotwire.editions.lamp.light",
        "object-added cobotwire.editions.lamp.shine",
    }
    assert [*promises.python_api(before, before)] == []


def test_page_without_packages_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(Failed, match="no row 'Python API'"):
        [*promises.python_api(tree(tmp_path, PACKAGE | {"docs/compatibility.md": ""}), tmp_path)]


def test_page_has_a_row_for_each_comparison_and_names_what_exists() -> None:
    page = (ROOT / "docs/compatibility.md").read_text("utf-8")
    assert [name for name in promises.PROMISES if f"| **{name}** |" not in page] == []
    for name in promises.promised_names(ROOT):
        parent, _, last = name.rpartition(".")
        assert not parent or hasattr(import_module(parent), last) or import_module(name)


def test_changed_id_and_rejected_spec_are_found(tmp_path: Path) -> None:
    spec = {"spec/editions/lamp.yaml": LAMP.read_text()}
    moved = {name: text.replace("id: 0x01", "id: 0x7E", 1) for name, text in spec.items()}
    old, new = tree(tmp_path / "old", spec), tree(tmp_path / "new", moved)
    assert [one.level for one in promises.editions(old, new) if one.rule == "id-changed"] == [
        "wire"
    ]
    assert [*promises.editions(old, old)] == [*promises.spec_language(old, new)] == []
    tree(old, {"spec/editions/lamp.yaml": f"no_such_key: 1\n{spec['spec/editions/lamp.yaml']}"})
    assert [one.rule for one in promises.editions(old, new)] == ["not-compared"]
    [rejected] = promises.spec_language(old, new)
    assert (rejected.rule, rejected.where) == (
        "rejected-by-unknown-key",
        "spec/editions/lamp.yaml:1:1",
    )


def test_recording_of_a_release_is_read_and_a_changed_one_is_reported(tmp_path: Path) -> None:
    assert [*promises.captures(ROOT, ROOT)] == []
    packets = [*capture.read(ROOT / RECORDED / "0.1.0.pcapng")]
    assert [(each.direction, each.data.hex()) for each in packets[:3]] == [
        ("sent", "fefe0220fa"),
        ("received", "fefe0e20000000000000000000000000fa"),
        ("sent", "fefe0223fa"),
    ]
    old = tmp_path / RECORDED
    shutil.copytree(ROOT / RECORDED, old)
    damaged = bytearray((old / "0.1.0.pcapng").read_bytes())
    damaged[4] ^= 0xFF
    (old / "0.1.0.pcapng").write_bytes(damaged)
    rules = [one.rule for one in promises.captures(tmp_path, ROOT)]
    assert rules == ["recording-removed", "recording-rejected"]


def test_edition_of_a_release_that_cannot_be_loaded_is_found(tmp_path: Path) -> None:
    name = "python/cobotwire/editions/{}/edition.json"
    whole = (ROOT / name.format("mycobot")).read_text("utf-8")
    without = {key: value for key, value in json.loads(whole).items() if key != "frame"}
    newer = json.dumps(json.loads(whole) | {"version": 99})
    texts = {"good": whole, "newer": newer, "odd": json.dumps(without)}
    tree(tmp_path, {name.format(each): text for each, text in texts.items()})
    found = [(one.rule, one.where) for one in promises.json_documents(tmp_path, ROOT)]
    assert found == [
        ("format-changed", name.format("newer")),
        ("not-loaded", name.format("odd")),
    ]


def test_added_subcommands_options_and_exit_codes_are_found(tmp_path: Path) -> None:
    cli = "python/cobotwire/cli"
    empty = dict.fromkeys(("python/cobotwire/__init__.py", f"{cli}/__init__.py"), "")
    app = {f"{cli}/app.py": "import click\n\napp = click.Group()\n"}
    codes = {f"{cli}/shared/exit_codes.py": "CODES = ()\n"}
    found = {*promises.command_line(tree(tmp_path, empty | app | codes), ROOT)}
    assert {one.rule for one in found} == {"word-added"}
    assert {one.where for one in found} >= {
        *("cobotwire call --json", "cobotwire conform device", "cobotwire studio --host"),
        "exit code 3: LinkError",
    }


@pytest.mark.parametrize(
    ("tags", "current", "last"),
    [
        ([], "0.1.0", None),
        (["v0.1.0"], "0.1.0", None),
        (["v0.9.0", "v0.10.0", "v0.11.0", "vendor", "v1"], "0.11.0", "v0.10.0"),
    ],
)
def test_last_release_is_the_highest_tag_below(tags: list[str], current: str, last: str) -> None:
    assert promises.last_release(tags, current) == last


def test_raised_part_of_a_version_number_is_named() -> None:
    found = [promises.raised("1.2.3", new) for new in ("1.2.3", "1.2.4", "1.3.0", "2.0.0")]
    assert found == ["none", "patch", "minor", "major"]


def test_news_fragments_are_valid() -> None:
    assert [
        path.name for path in (ROOT / "news").iterdir() if not path.read_text("utf-8").strip()
    ] == []
    command = (sys.executable, "-m", "towncrier", "build", "--draft", "--version", "9.9.9")
    ended = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
