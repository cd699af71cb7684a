"""Writes a first protocol: a commented file without problems."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.language.schema import schema_json


def first_protocol(name: str, schema: str) -> tuple[str, str]:
    """Return the texts of a protocol's file and of its schema; ``schema`` is its file name.

    Raises:
        SpecError: the name is not a valid edition name.
    """
    text = (files("cobotwire_codegen.author") / "protocol.yaml").read_text(encoding="utf-8")
    class_name = "".join(map(str.capitalize, name.split("_")))
    for placeholder, value in (("SCHEMA", schema), ("CLASS", class_name), ("NAME", name)):
        text = text.replace(placeholder, value)
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"{name}.yaml"
        path.write_text(text, encoding="utf-8")
        edition = build_edition(path, path.parent)
    check(edition)
    return text, schema_json([edition])
