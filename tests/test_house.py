"""Who may import whom: the arrows of ARCHITECTURE.md, held."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import vectors

PACKAGE = vectors.ROOT / "python" / "cobotwire"

# A part may import the parts behind it in this list, and nothing else of the package.
MAY_IMPORT: dict[str, set[str]] = {
    "errors": set(),
    "values": set(),
    "table": {"errors"},
    "codec": {"errors", "table", "_native"},
    "session": {"errors", "table", "codec", "diagnose"},
    "transport": {"errors"},
    "limits": {"errors", "table"},
    "driver": {"errors", "table", "limits", "codec", "session", "transport"},
    "capture": {"errors", "table", "codec"},
    "editions": {"errors", "table", "values", "driver"},
    "sim": {"errors", "table", "codec", "session", "capture"},
    "plot": {"errors", "table", "codec", "capture", "sim"},
    "explain": {"errors", "table", "codec"},
    "diagnose": {"errors", "table", "codec"},
    "health": {
        *("errors", "table", "codec", "diagnose", "session", "transport", "driver"),
    },
    "conformance": {
        *(
            "errors",
            "table",
            "codec",
            "session",
            "transport",
            "diagnose",
            "sim",
            "editions",
            "editions",
        ),
    },
    "demo": {"codec", "driver", "editions", "sim"},
    "testing": {"errors", "table", "codec", "driver", "editions", "sim"},
    "cli": {
        *("errors", "table", "codec", "driver", "editions", "sim", "session", "explain", "demo"),
        *("capture", "transport", "diagnose", "health", "conformance", "plot"),
    },
}
# Each library of the outside has one importer, so that it can be exchanged in one place.
ONE_IMPORTER = {
    "serial": ["transport/serial/"],
    "click": ["cli/"],
    "rich": ["cli/"],
    "pytest": ["testing/plugin.py", "conformance/pytest_"],
    "matplotlib": ["plot/drawing.py", "plot/pose.py"],
    "numpy": ["codec/columns.py"],
    "scipy": ["sim/kinematics/refine.py"],
    "pyarrow": ["codec/arrow.py"],
    "pymycobot": ["conformance/codec/adapter/pymycobot.py"],
    "ruamel": ["sim/faults/nodes.py"],
}


def _imports(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def _modules() -> list[Path]:
    return [path for path in sorted(PACKAGE.rglob("*.py")) if path != PACKAGE / "__init__.py"]


@pytest.mark.parametrize("path", _modules(), ids=lambda p: str(p.relative_to(PACKAGE)))
def test_a_module_imports_only_what_it_may(path: Path) -> None:
    own = path.relative_to(PACKAGE).parts[0].removesuffix(".py")
    parts = {entry.stem for entry in PACKAGE.iterdir()}
    for name in _imports(path):
        package, _, rest = name.partition(".")
        part = rest.partition(".")[0]
        if package == "cobotwire" and part in parts | {"_native"}:
            assert part == own or part in MAY_IMPORT[own], f"{path} imports {name}"
        for library, importers in ONE_IMPORTER.items():
            if package == library:
                place = path.relative_to(PACKAGE).as_posix()
                assert any(place.startswith(importer) for importer in importers), place


def test_every_part_has_its_rule() -> None:
    parts = {
        entry.stem for entry in PACKAGE.iterdir() if entry.suffix == ".py" or entry.is_dir()
    } - {"__init__", "__pycache__"}
    assert parts == set(MAY_IMPORT)


def test_the_generator_and_the_package_do_not_know_each_other() -> None:
    generator = vectors.ROOT / "codegen" / "src"
    for path in generator.rglob("*.py"):
        assert not any(name.split(".")[0] == "cobotwire" for name in _imports(path)), path
    for path in PACKAGE.rglob("*.py"):
        assert not any(name.split(".")[0] == "cobotwire_codegen" for name in _imports(path)), path


def test_the_rust_core_stands_alone() -> None:
    manifest = (vectors.ROOT / "rust/core/Cargo.toml").read_text()
    assert "[dependencies]" not in manifest


def test_importing_the_package_pulls_in_no_extra() -> None:
    script = (
        "import sys, cobotwire\n"
        "loaded = {name.split('.')[0] for name in sys.modules}\n"
        "extras = 'click rich numpy pyarrow ruamel jinja2 matplotlib pytest scipy'\n"
        "print(sorted(loaded & set(extras.split())))"
    )
    result = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert result.stdout == "[]\n"
