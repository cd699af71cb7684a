"""``cobotwire-gen build`` reports a user's mistake in one line and overwrites nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

import in_process
from cobotwire_codegen.cli import main
from in_process import Ended

LAMP = (Path(__file__).parent / "lamp.yaml").read_text()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "lamp.yaml").write_text(LAMP)
    return tmp_path


def run(folder: Path, *words: str) -> Ended:
    return in_process.run(main, "cobotwire-gen", *words, folder=folder)


def test_build_writes_package_reference_and_c_and_finds_them_fresh(folder: Path) -> None:
    words = ("build", "lamp.yaml", "--out", "lamp", "--docs", "docs", "--c", "c")
    assert run(folder, *words).returncode == 0
    assert (folder / "lamp" / "py.typed").is_file()
    assert sorted(path.name for path in (folder / "c").iterdir()) == ["lamp.c", "lamp.h"]
    again = run(folder, *words, "--check")
    assert (again.returncode, again.stdout) == (0, "fresh\n")


def test_build_writes_plugins_into_folder_with_other_files(folder: Path) -> None:
    (folder / "plugins").mkdir()
    (folder / "plugins" / "other.lua").write_text("of somebody else\n")
    words = ("build", "lamp.yaml", "--out", "lamp", "--wireshark", "plugins")
    assert run(folder, *words).returncode == 0
    assert sorted(path.name for path in (folder / "plugins").iterdir()) == ["lamp.lua", "other.lua"]
    assert run(folder, *words, "--check").returncode == 0


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
