"""Check what the distributions say of themselves: one version, the same links, absolute links."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
import tomllib
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pytest

import cobotwire
import front_end
from cobotwire import editions
from cobotwire.editions.clients import EDITIONS
from newcomer.installing import run
from vectors import ROOT

PROJECTS = {
    "cobotwire": ROOT / "pyproject.toml",
    "codegen": ROOT / "codegen" / "pyproject.toml",
    "lerobot": ROOT / "adapters" / "lerobot" / "pyproject.toml",
}
ADDED = ("codegen", "lerobot")
LINK = re.compile(r"\]\(([^)\s]+)\)")


def project(name: str) -> dict[str, Any]:
    table: dict[str, Any] = tomllib.loads(PROJECTS[name].read_text(encoding="utf-8"))["project"]
    return table


def test_version_is_stated_once_and_is_that_of_all_distributions() -> None:
    stated = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
    assert [project(name).get("version") for name in PROJECTS] == [None] * 3
    assert version("cobotwire") == version("cobotwire-codegen") == stated
    assert cobotwire.__version__ == stated
    crates = tomllib.loads((ROOT / "Cargo.lock").read_text())["package"]
    ours = [crate["version"] for crate in crates if crate["name"].startswith("cobotwire-")]
    assert len(ours) > 3
    assert {*ours} == {stated}
    for name in ("package.json", "package-lock.json"):
        assert json.loads((ROOT / "clients/typescript" / name).read_text())["version"] == stated


def test_stub_names_what_the_package_has() -> None:
    tree = ast.parse((ROOT / "python/cobotwire/__init__.pyi").read_text("utf-8"))
    stated = {
        alias.asname
        for node in tree.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    exported = vars(cobotwire)["__all__"]
    assert {*stated - {None}, *EDITIONS, "__version__", "codec_in_use"} == set(exported)
    for name in exported:
        assert getattr(cobotwire, name)
    assert {
        kind.__name__: name
        for name in editions.names()
        for kind in (editions.load(name).CLIENT, editions.load(name).ASYNC_CLIENT)
    } == EDITIONS


@pytest.mark.parametrize("name", ADDED)
def test_distributions_have_the_same_links_and_licence(name: str) -> None:
    assert project("cobotwire")["urls"] == project(name)["urls"]
    assert {"Documentation", "Repository", "Changelog", "Issues"} <= set(project(name)["urls"])
    licence = PROJECTS[name].with_name("LICENSE").read_text()
    assert licence == (ROOT / "LICENSE").read_text()


def declared() -> set[str]:
    """Return the names of the third-party packages that a file of the project requires."""
    stated: list[str] = []
    for path in PROJECTS.values():
        table = tomllib.loads(path.read_text("utf-8"))
        extras, groups = (
            table["project"].get("optional-dependencies", {}),
            table.get("dependency-groups", {}),
        )
        stated += [*table["build-system"]["requires"], *table["project"]["dependencies"]]
        stated += [
            each
            for group in (*extras.values(), *groups.values())
            for each in group
            if isinstance(each, str)
        ]
    found = {each.group() for text in stated if (each := re.match(r"[\w.-]+", text))}
    for path in ROOT.glob("rust/*/Cargo.toml"):
        table = tomllib.loads(path.read_text("utf-8"))
        for part in (table, *table.get("target", {}).values()):
            found |= {*part.get("dependencies", {}), *part.get("dev-dependencies", {})}
    found |= {package.name for package in front_end.PACKAGES}
    npm = json.loads((ROOT / "clients/typescript/package.json").read_text("utf-8"))
    found |= {*npm.get("dependencies", {}), *npm["devDependencies"], *npm["peerDependencies"]}
    texts = [path.read_text("utf-8") for path in (ROOT / ".github/workflows").glob("*.yml")]
    for pattern in (r"uses: ([\w-]+/[\w-]+)@", r"pipx run ([\w-]+)", r"go run \S+/([\w-]+)@"):
        found |= {*re.findall(pattern, "".join(texts))}
    found |= {
        *re.findall(
            r"cargo install .* (\S+)$", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE
        )
    }
    return {name for name in found if not name.startswith("cobotwire")}


def test_page_of_dependencies_names_each_and_no_version() -> None:
    page = (ROOT / "docs/contribute/dependencies.md").read_text("utf-8")
    table = page.partition("## What we write")[0]
    rows = re.findall(r"^\|([^|]*`[^|]*)\|", table, re.MULTILINE)
    named = [name for row in rows for name in re.findall(r"`([^`]+)`", row)]
    assert sorted(named) == sorted(declared())
    assert not re.search(r"\d\.\d", table)


@pytest.mark.parametrize("name", ["cobotwire", "codegen"])
def test_extra_all_has_every_other_extra(name: str) -> None:
    extras = project(name)["optional-dependencies"]
    [everything] = extras.pop("all")
    named = everything.partition("[")[2].rstrip("]").split(",")
    # Not `ros2`: its cyclonedds has no wheel for some machines, and `all` must install there.
    assert sorted(named) == sorted({*extras} - {"ros2"})


@pytest.mark.parametrize("name", ADDED)
def test_long_description_links_to_absolute_addresses_of_existing_files(name: str) -> None:
    """The long description of cobotwire is the README: tests/docs/test_readme.py."""
    repository = project(name)["urls"]["Repository"]
    links = LINK.findall(PROJECTS[name].with_name("README.md").read_text(encoding="utf-8"))
    assert links
    assert [link for link in links if not link.startswith("https://")] == []
    prefix = f"{repository}/blob/main/"
    ours = [link.removeprefix(prefix) for link in links if link.startswith(repository)]
    assert [path for path in ours if not (ROOT / path.partition("#")[0]).is_file()] == []


def installed(folder: Path, number: str) -> dict[str, str]:
    """Return an environment in which cobotwire seems to be installed in another version."""
    metadata = folder / f"cobotwire-{number}.dist-info" / "METADATA"
    metadata.parent.mkdir()
    metadata.write_text(f"Metadata-Version: 2.1\nName: cobotwire\nVersion: {number}\n")
    return {"PYTHONPATH": f"{folder}:{ROOT / 'codegen' / 'src'}"}


@pytest.mark.parametrize("words", [["--version"], ["schema"]])
def test_generator_refuses_a_package_of_another_version(tmp_path: Path, words: list[str]) -> None:
    command = [sys.executable, "-m", "cobotwire_codegen", *words]
    ours = version("cobotwire-codegen")
    run(*command, "--help", env=installed(tmp_path, ours))
    (tmp_path / "other").mkdir()
    with pytest.raises(subprocess.CalledProcessError) as caught:
        run(*command, env=installed(tmp_path / "other", "9.8.7"))
    expected = f"cobotwire-codegen is {ours}, but the installed cobotwire is 9.8.7."
    assert expected in " ".join("".join(caught.value.__notes__).split())
