"""Install both wheels in a fresh environment without Rust, and build protocols there."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import vectors
from cobotwire.studio.extras import CURVES
from newcomer.installing import run

SERVO = vectors.ROOT / "tests" / "protocols" / "feetech.yaml"


def test_first_program_of_the_readme_needs_no_generator() -> None:
    absent = "import sys; sys.modules['cobotwire_codegen'] = None; import newcomer.first_program"
    done = subprocess.run([sys.executable, "-c", absent], cwd=vectors.ROOT / "tests", check=False)
    assert done.returncode == 0


@pytest.mark.skipif(not CURVES.is_file(), reason="uPlot is missing: run `make front-end`")
def test_wheel_ships_the_page_of_the_studio_with_its_library(wheels: list[Path]) -> None:
    [native] = [wheel for wheel in wheels if wheel.name.startswith("cobotwire-")]
    folder = "cobotwire/studio/page/"
    page = {name.removeprefix(folder) for name in zipfile.ZipFile(native).namelist()}
    assert {"index.html", "main.js", "vendor/uPlot.iife.min.js", "vendor/LICENSE-uPlot"} <= page


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
    (tmp_path / "servo.yaml").write_bytes(SERVO.read_bytes())
    own = tmp_path / "templates" / "python"
    own.mkdir(parents=True)
    template = '"""{{ edition.types | select("enum") | list | length }} enums of our own."""\n'
    (own / "enums.py.j2").write_text(template)
    words = ("build", "servo.yaml", "--out", "servo", "--templates", "templates")
    run("cobotwire-gen", *words, cwd=tmp_path, env=environment)
    assert (tmp_path / "servo" / "enums.py").read_text() == '"""0 enums of our own."""\n'


def test_build_into_folder_with_other_files_fails_and_changes_nothing(
    tmp_path: Path, environment: dict[str, str]
) -> None:
    (tmp_path / "servo.yaml").write_bytes(SERVO.read_bytes())
    (tmp_path / "servo").mkdir()
    (tmp_path / "servo" / "thesis.py").write_text("# years of work\n")
    words = ("build", "servo.yaml", "--out", "servo")
    with pytest.raises(subprocess.CalledProcessError) as caught:
        run("cobotwire-gen", *words, cwd=tmp_path, env=environment)
    assert "the folder contains files that were not generated" in caught.value.stderr
    assert (tmp_path / "servo" / "thesis.py").read_text() == "# years of work\n"
