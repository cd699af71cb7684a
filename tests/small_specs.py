"""Small protocols for tests: the commands are given, everything around them is always the same."""

from __future__ import annotations

import importlib
import sys
from itertools import count
from pathlib import Path
from types import ModuleType

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import render_python

HEAD = """\
edition: small
class: Small
title: A small protocol
doc: A small protocol.
joints: 0
frame:
  frame:
    header: FE FE
    footer: FA
    length_counts: [command, data, footer]
    maximum_data: 20
    doc: A frame.
  transport: {baudrate: 9600, deadline_ms: 200}
types:
  wire:
    byte: {bytes: 1, doc: A byte.}
    word: {bytes: 2, order: big, signed_at: 32767, doc: A signed word.}
  quantities:
    small: {wire: byte, doc: A small number.}
    percent: {wire: byte, range: [1, 100], unit: percent, doc: A share.}
    big: {wire: word, doc: A big number.}
    warmth: {wire: word, scale: 1/10, unit: degree_celsius, range: [-40, 120], doc: A warmth.}
    angle: {wire: word, scale: 1/10, unit: degree, shown_in: radian, doc: An angle.}
  flags:
    flag: {wire: byte, doc: Yes or no.}
  enums:
    mode:
      class: Mode
      wire: byte
      doc: How it shines.
      members:
        STEADY: {value: 0, doc: Without a break.}
        BLINK: {value: 1, doc: On and off.}
    tool:
      class: Tool
      wire: byte
      doc: What is mounted.
      members:
        GRIPPER: {value: 14, doc: Two fingers.}
        PUMP: {value: 15, doc: A pump.}
  values:
    pair:
      class: Pair
      doc: Two warmths.
      items: {inner: warmth, outer: warmth}
"""
PYTHON = Path(__file__).resolve().parent.parent / "python"
_NUMBERS = count()


def build(folder: Path, commands: str, vectors: str = "") -> Edition:
    """Return the protocol with these commands; it is not checked yet."""
    path = folder / "small.yaml"
    text = f"{HEAD}commands:\n{_indented(commands)}"
    path.write_text(text + (f"vectors:\n{_indented(vectors)}" if vectors else ""))
    return build_edition(path, folder)


def problems(folder: Path, commands: str, vectors: str = "") -> list[str]:
    """Return the problems of a protocol as ``code: message``, without those of missing vectors."""
    try:
        check(build(folder, commands, vectors))
    except SpecError as error:
        found = [f"{problem.code}: {problem.message}" for problem in error.problems]
        return [text for text in found if not text.startswith("no-vector")]
    return []


def package(folder: Path, edition: Edition) -> ModuleType:
    """Return the imported Python package of an edition."""
    name = f"small{next(_NUMBERS)}"
    write(Target(folder / name, render_python(edition)))
    sys.path.insert(0, str(folder))
    importlib.invalidate_caches()
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(str(folder))


def _indented(text: str) -> str:
    return "".join(f"  {line}\n" for line in text.strip("\n").splitlines())
