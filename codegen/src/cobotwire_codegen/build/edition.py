"""An edition file, and through it every other file of the edition and of its base."""

from __future__ import annotations

from pathlib import Path

from cobotwire_codegen.build.commands import build_family
from cobotwire_codegen.build.delta import apply_changes
from cobotwire_codegen.build.frame import build_frame_format
from cobotwire_codegen.build.parts import Files, Parts, add_own
from cobotwire_codegen.build.types import Types
from cobotwire_codegen.build.vectors import build_erratum, build_vector
from cobotwire_codegen.errors import Problem, SpecError
from cobotwire_codegen.model import Edition
from cobotwire_codegen.reader import Reader

_OWN = ("edition", "class", "title", "doc", "document", "firmware")


def build_edition(path: Path, root: Path) -> Edition:
    """Read an edition; file names in messages are relative to ``root``.

    Raises:
        SpecError: with every problem that reading found.
    """
    problems: list[Problem] = []
    reader, parts = _collect(path, root, problems, ())
    edition = _build(reader, parts, problems)
    if problems:
        raise SpecError(problems)
    return edition


def _collect(
    path: Path, root: Path, problems: list[Problem], above: tuple[Path, ...]
) -> tuple[Reader, Parts]:
    """The parts of an edition: the base's, changed by the delta, with the edition's own."""
    files = Files(path.parent, root, problems)
    reader = Reader(files.load(path), "the edition", problems)
    base = reader.node("base")
    parts = Parts()
    if base is not None:
        above = (*above, path.resolve())
        base_path = files.path(base)
        if base_path.resolve() in above:
            problem = Problem(base.place, "base-circle", "an edition cannot stand on itself")
            raise SpecError([*problems, problem])
        base_reader, parts = _collect(base_path, root, problems, above)
        for key in _OWN:
            base_reader.node(key)
        base_reader.done()
        # The base's errata speak of the base's document; its changes are its own story.
        parts.errata, parts.changes, parts.general_changes = [], {}, []
        for node in files.listed(reader, "changes"):
            apply_changes(parts, node, problems)
    add_own(parts, reader, files)
    return reader, parts


def _build(reader: Reader, parts: Parts, problems: list[Problem]) -> Edition:
    frame = build_frame_format(parts, reader, problems)
    types = Types(parts.types, problems)
    edition = Edition(
        place=reader.place,
        name=reader.text("edition"),
        class_name=reader.text("class"),
        title=reader.text("title"),
        doc=reader.text("doc"),
        document=reader.text("document", ""),
        firmware=reader.text("firmware", ""),
        base=reader.text("base", "").rpartition("/")[2].removesuffix(".yaml"),
        joints=parts.joints or 0,
        frame=frame,
        wires=tuple(types.wires.values()),
        types=tuple(types.types.values()),
        families=tuple(
            build_family(family, parts, types, frame.deadline_ms, problems)
            for family in parts.families.values()
            if family.commands
        ),
        errata=tuple(build_erratum(node, problems) for node in parts.errata),
        vectors=tuple(build_vector(node, problems) for node in parts.vectors),
        changes=tuple(parts.general_changes),
    )
    reader.done()
    return edition
