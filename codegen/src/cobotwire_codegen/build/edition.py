"""An edition file, and through it every other file of the edition."""

from __future__ import annotations

from pathlib import Path

from cobotwire_codegen.build.commands import build_family
from cobotwire_codegen.build.types import Types
from cobotwire_codegen.build.vectors import build_errata, build_vectors
from cobotwire_codegen.errors import Problem, SpecError
from cobotwire_codegen.load import Node, Scalar, load
from cobotwire_codegen.model import Edition, Family, Frame, Vector
from cobotwire_codegen.reader import Reader


def build_edition(path: Path, root: Path) -> Edition:
    """Read an edition; file names in messages are relative to ``root``.

    Raises:
        SpecError: with every problem that reading found.
    """
    problems: list[Problem] = []
    files = _Files(path, root, problems)
    reader = Reader(files.load(path), "the edition", problems)
    frame = _frame(files.named(reader, "frame"), problems)
    types = Types(files.named(reader, "types"), problems)
    families: list[Family] = []
    for node in files.listed(reader, "commands"):
        families.append(build_family(node, types, frame.deadline_ms, problems))
    vectors: list[Vector] = []
    for node in files.listed(reader, "vectors"):
        vectors.extend(build_vectors(node, problems))
    edition = Edition(
        place=reader.place,
        name=reader.text("edition"),
        class_name=reader.text("class"),
        title=reader.text("title"),
        doc=reader.text("doc"),
        document=reader.text("document", ""),
        joints=reader.integer("joints"),
        frame=frame,
        wires=tuple(types.wires.values()),
        types=tuple(types.types.values()),
        families=tuple(families),
        errata=build_errata(files.named(reader, "errata"), problems),
        vectors=tuple(vectors),
    )
    reader.done()
    if problems:
        raise SpecError(problems)
    return edition


class _Files:
    """Loads the files that an edition names, relative to the edition's own."""

    def __init__(self, edition: Path, root: Path, problems: list[Problem]) -> None:
        self._folder = edition.parent
        self._root = root
        self._problems = problems

    def load(self, path: Path) -> Node:
        path = path.resolve()
        root = self._root.resolve()
        shown = path.relative_to(root) if path.is_relative_to(root) else path
        return load(path, shown.as_posix())

    def named(self, reader: Reader, key: str) -> Node:
        node = reader.required(key)
        return self._at(node) if node is not None else Scalar(reader.place, None)

    def listed(self, reader: Reader, key: str) -> list[Node]:
        return [self._at(node) for node in reader.items(key)]

    def _at(self, node: Node) -> Node:
        name = node.value if isinstance(node, Scalar) else None
        if not isinstance(name, str) or not (self._folder / name).is_file():
            raise SpecError(
                [*self._problems, Problem(node.place, "no-file", f"there is no file {name}")]
            )
        return self.load(self._folder / name)


def _frame(root: Node, problems: list[Problem]) -> Frame:
    reader = Reader(root, "the frame file", problems)
    frame = Reader(reader.required("frame") or root, "the frame", problems)
    link = Reader(reader.required("link") or root, "the link", problems)
    counts = frame.texts("length_counts")
    if counts != ("command", "data", "footer"):
        frame.problem("bad-frame", "length_counts must be [command, data, footer]")
    frame.lines("source")
    for word in ("data_bits", "stop_bits"):
        link.integer(word)
    link.one_of("parity", ("none", "even", "odd"))
    link.lines("source")
    built = Frame(
        place=frame.place,
        header=frame.bytes("header") or b"",
        footer=frame.bytes("footer") or b"",
        maximum_data=frame.integer("maximum_data"),
        doc=frame.text("doc"),
        baudrate=link.integer("baudrate"),
        deadline_ms=link.integer("deadline_ms"),
    )
    if len(built.header) != 2 or len(built.footer) != 1:
        frame.problem("bad-frame", "the header has two bytes and the footer one")
    for part in (frame, link, reader):
        part.done()
    return built
