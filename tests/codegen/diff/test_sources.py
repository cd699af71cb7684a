"""OLD and NEW may be files, folders, or revisions of real repositories."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from cobotwire_codegen.diff import diff_all
from cobotwire_codegen.diff.sources import SourceError, paired, read
from cobotwire_codegen.errors import SpecError

BASE = (Path(__file__).parent / "base.yaml").read_text()


def git(folder: Path, *words: str) -> None:
    who = ("-c", "user.name=test", "-c", "user.email=test@example.org")
    subprocess.run(["git", *who, *words], cwd=folder, check=True, capture_output=True)


def put(folder: Path, text: str, name: str = "small") -> Path:
    path = folder / "spec" / "editions" / f"{name}.yaml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


@pytest.fixture
def repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Change to a repository with two revisions of a spec, v1 and v2."""
    folder = tmp_path / "repository"
    folder.mkdir()
    git(folder, "init", "--initial-branch=main")
    for tag, number in (("v1", "0x22"), ("v2", "0x23")):
        put(folder, BASE.replace("0x22", number))
        git(folder, "add", ".")
        git(folder, "commit", "-m", tag)
        git(folder, "tag", "-a", tag, "-m", tag)
    monkeypatch.chdir(folder)
    return folder


def rules(old: str, new: str) -> list[str]:
    return [one.rule for one in diff_all(*paired(read(old), read(new)))]


def test_diff_compares_revisions_of_the_repository(repository: Path) -> None:
    assert rules("v1", "v2") == ["id-changed"]
    assert rules("v2", "HEAD") == []
    assert rules("HEAD~1", "main") == ["id-changed"]


def test_diff_compares_a_revision_with_uncommitted_files(repository: Path) -> None:
    path = put(repository, BASE.replace("joints: 2", "joints: 3"))
    assert rules("v1", ".") == ["joints-changed"]
    assert rules("v1", str(path)) == ["joints-changed"]
    assert rules(str(path), "v1") == ["joints-changed"]


def test_diff_of_folders_reports_added_and_removed_editions(repository: Path) -> None:
    put(repository, BASE.replace("edition: small", "edition: other"), "other")
    assert rules("v2", ".") == ["edition-added"]
    assert rules(".", "v2") == ["edition-removed"]


def test_diff_of_revisions_works_in_a_subfolder_of_the_repository(
    repository: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    inside = repository / "inside"
    put(inside, BASE)
    git(repository, "add", ".")
    git(repository, "commit", "-m", "inside")
    monkeypatch.chdir(inside)
    assert rules("HEAD", ".") == []
    with pytest.raises(SourceError, match=r"the revision v1 holds no spec/ here"):
        read("v1")


@pytest.mark.parametrize("word", ["v3", "--help", "-v", "v1..v2", "nowhere/spec.yaml", ""])
def test_unknown_source_is_an_error(repository: Path, word: str) -> None:
    with pytest.raises(SourceError, match="is not a file, a folder or a git revision"):
        read(word) if word else read("\t")


def test_comparing_a_folder_without_a_spec_fails(repository: Path) -> None:
    (repository / "empty").mkdir()
    with pytest.raises(SourceError, match="the folder empty contains no spec/editions"):
        read("empty")


def test_comparing_a_file_without_a_matching_edition_fails(repository: Path) -> None:
    path = put(repository, BASE.replace("edition: small", "edition: other"), "other")
    with pytest.raises(SourceError, match="there is no edition other in v1"):
        paired(read(str(path)), read("v1"))


def test_diff_outside_a_repository_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SourceError, match="is not a file, a folder or a git revision"):
        read("HEAD")


def test_diff_reports_that_git_is_missing(
    repository: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(repository))
    with pytest.raises(SourceError, match="git is not installed"):
        read("v1")


def test_problem_of_a_compared_spec_is_reported_with_its_revision(repository: Path) -> None:
    put(repository, BASE.replace("safety: motion", "safety: moton"))
    git(repository, "commit", "-am", "bad")
    with pytest.raises(SpecError, match=r"HEAD:spec/editions/small\.yaml:96:17: unknown-word: "):
        read("HEAD")
