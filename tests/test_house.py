"""Check the structure of ARCHITECTURE.md: the subpackages, the permitted imports, and no cycles."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import vectors
from module_graph import (
    import_cycle,
    imports_of_parts,
    modules_in_texts,
    python_imports,
    python_imports_of,
    rust_imports_of,
)

PACKAGE = vectors.ROOT / "python" / "cobotwire"
LEROBOT = vectors.ROOT / "adapters/lerobot/src/lerobot_robot_cobotwire"

# The subpackages of cobotwire. Each may import only those above it.
SUBPACKAGES = (
    "protocol",
    "codec",
    "diagnose",
    "kinematics",
    "transport",
    "capture",
    "session",
    "client",
    "editions",
    "pymycobot",
    "simulator",
    "inspect",
    "conformance",
    "studio",
    "adapters",
    "cli",
)
# Each third-party library has one importer, so that it can be replaced in one place.
ONE_IMPORTER = {
    "serial": ["transport/serial/"],
    "click": ["cli/"],
    "rich": ["cli/"],
    "pytest": ["simulator/testing/plugin.py", "conformance/pytest_"],
    "matplotlib": ["inspect/plot/charts.py", "inspect/plot/pose.py"],
    "numpy": ["codec/columns.py"],
    "scipy": [],
    "pyarrow": ["codec/arrow", "capture/archive/scanning.py", "capture/export/"],
    "mcap": ["capture/export/formats/mcap_file.py"],
    "fsspec": ["capture/export/inputs.py"],
    "ruckig": ["kinematics/jerk_limited.py"],
    "pymycobot": ["conformance/codec/adapter/pymycobot.py"],
    "libcst": ["pymycobot/migrate/"],
    "cryptography": ["inspect/ed25519.py"],
    "defusedxml": ["kinematics/urdf_reading.py"],
    "yourdfpy": [],
    "ruamel": ["simulator/faults/nodes.py"],
    "mcp": ["adapters/mcp/server.py"],
    "cyclonedds": ["adapters/ros2/dds.py"],
    "starlette": ["studio/app.py", "studio/feed.py", "studio/serving.py"],
    "uvicorn": ["studio/accepting.py", "studio/serving.py"],
}


@pytest.mark.parametrize("path", sorted(PACKAGE.rglob("*.py")), ids=lambda path: str(path)[-60:])
def test_module_imports_only_subpackages_above_its_own(path: Path) -> None:
    place = path.relative_to(PACKAGE)
    subpackage = place.parts[0].removesuffix(".py")
    if subpackage == "__init__":
        return
    allowed = {*SUBPACKAGES[: SUBPACKAGES.index(subpackage) + 1]}
    if subpackage in ("codec", "transport", "cli"):
        allowed.add("_native")
    module = "cobotwire." + ".".join(place.with_suffix("").parts)
    for name in (*python_imports(path, module), *modules_in_texts(path, "cobotwire")):
        package, _, rest = name.partition(".")
        part = rest.partition(".")[0]
        if package == "cobotwire" and part in {*SUBPACKAGES, "_native"}:
            assert part in allowed, f"{place} imports {name}"
        if package in ONE_IMPORTER:
            assert any(place.as_posix().startswith(p) for p in ONE_IMPORTER[package]), name


def test_package_holds_the_subpackages_and_nothing_else() -> None:
    found = {entry.stem for entry in PACKAGE.iterdir() if entry.suffix == ".py" or entry.is_dir()}
    # The spec is a link: the wheel contains it.
    assert found - {"__init__", "__pycache__", "spec"} == set(SUBPACKAGES)


@pytest.mark.parametrize(
    ("root", "name"),
    [
        (PACKAGE, "cobotwire"),
        (vectors.ROOT / "codegen/src/cobotwire_codegen", "cobotwire_codegen"),
        (LEROBOT, "lerobot_robot_cobotwire"),
    ],
    ids=["package", "generator", "adapter of LeRobot"],
)
def test_python_modules_and_folders_have_no_import_cycle(root: Path, name: str) -> None:
    imports = python_imports_of(root, name)
    assert import_cycle(imports) == []
    for package in {module.rpartition(".")[0] for module in imports} - {""}:
        assert import_cycle(imports_of_parts(imports, package)) == [], package


@pytest.mark.parametrize("crate", ["core", "py", "fuzz"])
def test_rust_modules_have_no_import_cycle(crate: str) -> None:
    assert import_cycle(rust_imports_of(vectors.ROOT / "rust" / crate / "src")) == []


def test_one_module_imports_lerobot() -> None:
    for path in LEROBOT.glob("*.py"):
        packages = {name.partition(".")[0] for name in python_imports(path, "x")}
        assert ("lerobot" in packages) is (path.stem == "interface"), path


def test_generator_and_package_do_not_import_each_other() -> None:
    generator = vectors.ROOT / "codegen" / "src"
    for root, other in [(generator, "cobotwire"), (PACKAGE, "cobotwire_codegen")]:
        for path in root.rglob("*.py"):
            packages = {name.split(".")[0] for name in python_imports(path, "x")}
            assert other not in packages, path


def test_rust_core_depends_only_on_the_crate_of_instructions() -> None:
    core, simd = (
        tomllib.loads((vectors.ROOT / "rust" / crate / "Cargo.toml").read_text())
        for crate in ("core", "simd")
    )
    assert list(core["dependencies"]) == ["cobotwire-simd"]
    assert "dependencies" not in simd


def test_sources_of_the_rust_core_have_no_tests_because_none_would_run() -> None:
    core = vectors.ROOT / "rust" / "core"
    assert tomllib.loads((core / "Cargo.toml").read_text())["lib"]["test"] is False
    for path in (core / "src").rglob("*.rs"):
        text = path.read_text("utf-8")
        assert "#[test]" not in text, path
        assert not re.search(r"^\s*//[/!] ```", text, re.MULTILINE), path


def test_unsafe_rust_code_is_only_in_the_files_for_it() -> None:
    rust = vectors.ROOT / "rust"
    found = {
        path.relative_to(rust).as_posix()
        for path in rust.rglob("*.rs")
        if "target" not in path.parts
        and any(
            re.search(r"\bunsafe\b|allow\(unsafe_code", line.partition("//")[0])
            for line in path.read_text("utf-8").splitlines()
        )
    }
    instructions = {name for name in found if name.startswith("simd/src/")}
    assert instructions
    # The attribute of an exported function is unsafe; the module has no other unsafe code.
    assert found - instructions == {"py/src/memory.rs", "py/src/descriptor.rs", "wasm/src/lib.rs"}


def test_native_classes_are_never_borrowed_mutably() -> None:
    # While a call borrows an object mutably, PyO3 raises RuntimeError for every other use of it,
    # such as a call of another thread. A frozen class has no such borrows.
    for path in (vectors.ROOT / "rust" / "py" / "src").rglob("*.rs"):
        text = path.read_text("utf-8")
        for declared in re.findall(r"#\[pyclass\(.*", text):
            assert "frozen" in declared, f"{path}: {declared}"
        assert "try_borrow" not in text, path


def test_native_module_does_not_use_the_exchange() -> None:
    # The Python session alone owns an exchange. A native call that reads or sets its attributes
    # would be a second owner.
    stub = (PACKAGE / "_native.pyi").read_text("utf-8")
    assert set(re.findall(r"^from cobotwire\.(\w+)", stub, re.MULTILINE)) <= set(SUBPACKAGES[:3])
    exchanging, others = (
        {
            name
            for subpackage in subpackages
            for path in (PACKAGE / subpackage).rglob("*.py")
            for name in re.findall(r"\b(?:self\.|def )((?!__)\w+)", path.read_text("utf-8"))
        }
        for subpackages in (("transport", "session", "client"), SUBPACKAGES[:3])
    )
    named = re.compile(r"(?:intern!\(\w+, |attr\(|call_method[01]?\()\"(\w+)\"")
    for path in (vectors.ROOT / "rust" / "py" / "src").rglob("*.rs"):
        used = set(named.findall(path.read_text("utf-8")))
        assert not used & (exchanging - others), path


def test_importing_the_package_loads_no_extra() -> None:
    script = (
        "import sys, cobotwire\n"
        "loaded = {name.split('.')[0] for name in sys.modules}\n"
        "extras = 'click rich numpy pyarrow ruamel jinja2 matplotlib pytest scipy uvicorn ruckig'\n"
        "print(sorted(loaded & set(extras.split())))"
    )
    result = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert result.stdout == "[]\n"
