"""Compile editions to programs that tests run, or name the tool that is missing."""

from __future__ import annotations

import atexit
import shutil
import subprocess
import tempfile
from functools import lru_cache
from pathlib import Path

from cobotwire_codegen.model import Edition
from cobotwire_codegen.targets.c import render_c
from targets.c.glue import glue

HERE = Path(__file__).parent
COMPILERS = ("gcc", "clang")
_WARNED = """-std=c99 -Wall -Wextra -Werror -pedantic -Wconversion -Wsign-conversion -Wshadow
-Wstrict-prototypes -Wundef"""
WARNINGS = _WARNED.split()
SANITIZERS = ("-g", "-O0", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")


@lru_cache
def missing(*tools: str) -> str:
    """Return why a test that needs these programs cannot run here; empty if it can."""
    absent = [tool for tool in tools if shutil.which(tool) is None]
    return f"needs {', '.join(absent)}: not installed" if absent else ""


@lru_cache
def scratch() -> Path:
    """Return a folder that is removed when the tests end."""
    folder = Path(tempfile.mkdtemp(prefix="cobotwire-c-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def sources(edition: Edition, name: str = "") -> Path:
    """Return a folder with the edition's header and source."""
    folder = scratch() / (name or edition.name)
    folder.mkdir(exist_ok=True)
    for path, text in render_c(edition).items():
        (folder / path).write_text(text)
    return folder


def program(
    edition: Edition, compiler: str = "gcc", flags: tuple[str, ...] = SANITIZERS, name: str = ""
) -> Path:
    """Compile the harness with the edition's code, once; ``name`` names a changed edition."""
    folder = sources(edition, name)
    (folder / "physical.h").write_text(glue(edition))
    out = folder / f"harness-{compiler}"
    if out.exists():
        return out
    names = f"-D{edition.name.upper()}_NAMES"
    files = [str(HERE / "harness.c"), str(folder / f"{edition.name}.c")]
    compile_c(compiler, *flags, names, f"-I{folder}", *files, "-o", str(out))
    return out


def compile_c(compiler: str, *arguments: str) -> None:
    """Compile with every warning as an error; fail with the compiler's output."""
    command = [compiler, *WARNINGS, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stderr}"
