"""The C code compiles without warnings, needs no library and keeps no state."""

from __future__ import annotations

import re
import subprocess
from functools import lru_cache
from pathlib import Path

import pytest

import vectors
from targets.built import built
from targets.c.compiled import compile_c, missing, scratch, sources
from targets.specs import SPECS, edition_of
from vectors import ROOT

# Another test reads the code of every edition; this one takes all steps of a compiler.
EDITION = "mycobot280"
FREE = "-ffreestanding"
BUILDS = [
    ("gcc", ("-O2", FREE)),
    ("clang", ("-O2", FREE)),
    ("clang", ("-Os", FREE, "--target=thumbv7m-none-eabi")),
    ("arm-none-eabi-gcc", ("-Os", FREE, "-mcpu=cortex-m0plus", "-mthumb")),
]


def _needs(*tools: str) -> pytest.MarkDecorator:
    return pytest.mark.skipif(bool(missing(*tools)), reason=missing(*tools))


@pytest.mark.parametrize(
    ("compiler", "flags"), [pytest.param(*build, marks=_needs(build[0])) for build in BUILDS]
)
def test_c_code_compiles_without_warnings(compiler: str, flags: tuple[str, ...]) -> None:
    _object(compiler, flags)


@_needs("arm-none-eabi-gcc", "arm-none-eabi-nm", "arm-none-eabi-size")
def test_c_library_needs_flash_only() -> None:
    made = _object(*BUILDS[-1])
    needed = _output("arm-none-eabi-nm", "--undefined-only", made).split()
    assert [name for name in needed if name != "U"] in ([], ["memcpy"])
    sizes = _output("arm-none-eabi-size", made).splitlines()[1].split()
    text, data, bss = map(int, sizes[:3])
    assert (data, bss) == (0, 0), "no state, and tables in flash"
    assert text < 8192


@pytest.mark.parametrize(
    "compiler", [pytest.param(name, marks=_needs(name)) for name in ("clang", "arm-none-eabi-gcc")]
)
def test_c_code_of_every_spec_compiles_without_warnings(compiler: str) -> None:
    # The Arm ABI gives an enum the smallest integer that holds its members.
    folders = _every_folder()
    files = [str(path) for folder in folders for path in folder.glob("*.c")]
    assert len(files) == len(folders)
    compile_c(compiler, FREE, "-fsyntax-only", *files)


def _every_folder() -> list[Path]:
    """Return the folders with the C code of each shipped edition, and of the specs of tests."""
    shipped = sorted(path for path in built("c").iterdir() if path.is_dir())
    return [*shipped, *(sources(edition_of(name)) for name in SPECS)]


@_needs("g++")
def test_cpp_program_can_include_the_headers() -> None:
    source = scratch() / "includes.cpp"
    headers = [path for folder in _every_folder() for path in folder.glob("*.h")]
    names = [path for path in headers if path.name != "physical.h"]
    source.write_text("".join(f'#include "{path}"\n' for path in names))
    command = ["g++", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", str(source)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@_needs("gcc")
def test_firmware_loop_of_the_guide_compiles_and_replies() -> None:
    text = (ROOT / "docs" / "c.md").read_text()
    loop = re.search(r"```c\n(.*?)```", text, re.DOTALL)
    assert loop is not None
    source, made = scratch() / "loop.c", scratch() / "loop"
    source.write_text(loop[1])
    folder = built("c") / "mycobot280"
    main = str(vectors.ROOT / "tests" / "targets" / "c" / "loop_main.c")
    compile_c(
        "gcc", f"-I{folder}", str(source), main, str(folder / "mycobot280.c"), "-o", str(made)
    )
    stdin = bytes.fromhex("00 FE FE 02 20 FA FE FE 03 FF FA")
    done = subprocess.run([made], input=stdin, capture_output=True, check=True)
    assert done.stdout == bytes.fromhex("FE FE 0E 20 00 00 23 28 DC D8 00 00 00 00 00 00 FA")


@lru_cache
def _object(compiler: str, flags: tuple[str, ...]) -> str:
    made = scratch() / f"{EDITION}-{compiler}-{len(flags)}.o"
    source = built("c") / EDITION / f"{EDITION}.c"
    compile_c(compiler, *flags, "-c", str(source), "-o", str(made))
    return str(made)


def _output(tool: str, *arguments: str) -> str:
    return subprocess.run([tool, *arguments], capture_output=True, text=True, check=True).stdout
