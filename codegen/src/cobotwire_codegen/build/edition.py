"""Builds an edition from its own files and from those of its base."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from cobotwire_codegen import language
from cobotwire_codegen.build.commands import build_family
from cobotwire_codegen.build.delta import apply_changes
from cobotwire_codegen.build.effects import build_state
from cobotwire_codegen.build.evidence import build_evidence, with_disputes
from cobotwire_codegen.build.frame import build_frame_format
from cobotwire_codegen.build.inherit import carried
from cobotwire_codegen.build.parts import Files, Inherited, Parts, Texts, add_own, drop_firmware
from cobotwire_codegen.build.read_back import with_read_back
from cobotwire_codegen.build.robot import build_robot
from cobotwire_codegen.build.types import Types
from cobotwire_codegen.build.vectors import build_erratum, build_vector
from cobotwire_codegen.errors import Problem, SpecError
from cobotwire_codegen.load import Node
from cobotwire_codegen.model import Edition, Family, Frame, Vector
from cobotwire_codegen.reader import Reader

MOST_BASES = 10
# Editions without problems, by the resolved path of their file.
Built = dict[Path, Edition]


def build_edition(
    path: Path,
    root: Path,
    unsaved: Mapping[Path, str | Node] | None = None,
    built: Built | None = None,
) -> Edition:
    """Return an edition; file names in messages are relative to ``root``.

    Args:
        path: the edition's file.
        root: the folder to which file names in messages are relative.
        unsaved: texts or nodes that replace the content of files on disk, by resolved path.
        built: editions that were built earlier from the same files. Bases are taken from here, and
            new editions are added. Without it, each base is built again.

    Raises:
        SpecError: reading found problems; the error carries all of them.
    """
    problems: list[Problem] = []
    texts, built = Texts(root, unsaved or {}), {} if built is None else built
    reader, parts = _collect(path, texts, problems, (), built)
    edition = _built(path, reader, parts, problems, built)
    if problems:
        raise SpecError(problems, edition)
    return edition


def _collect(
    path: Path, texts: Texts, problems: list[Problem], above: tuple[Path, ...], built: Built
) -> tuple[Reader, Parts]:
    """Return the parts of an edition: those of its base, changed by the delta, then its own."""
    files = Files(path.parent, texts, problems)
    reader = Reader(files.load(path), language.EDITION, "the edition", problems)
    is_delta = reader.record is language.DeltaEdition
    base = reader.node(language.DeltaEdition.base) if is_delta else None
    parts = Parts(texts.root)
    if base is not None:
        above = (*above, path.resolve())
        base_path = files.path(base)
        if base_path.resolve() in above:
            problem = Problem(base.place, "circular-base", "an edition cannot be its own base")
            raise SpecError([*problems, problem])
        if len(above) > MOST_BASES:
            message = f"the edition has a chain of more than {MOST_BASES} bases, the limit"
            raise SpecError([*problems, Problem(base.place, "too-large", message)])
        base_reader, parts = _collect(base_path, texts, problems, above, built)
        parts.base = _built(base_path, base_reader, parts, problems, built)
        parts.vectors = []
        observed = {name for each in parts.base.observed for name in each.vectors}
        parts.inherited = [
            Inherited(each, each.command)
            for each in parts.base.vectors
            if each.name not in observed
        ]
        # The base's errata are about the base's document, its changes about its own base, and its
        # evidence about another robot.
        parts.errata, parts.changes, parts.general_changes, parts.gone = [], {}, [], {}
        drop_firmware(parts)
        parts.evidence = []
        for node in files.listed(reader, language.DeltaEdition.changes):
            apply_changes(parts, node, problems)
    add_own(parts, reader, files)
    return reader, parts


def _built(
    path: Path, reader: Reader, parts: Parts, problems: list[Problem], built: Built
) -> Edition:
    """Return the edition of these parts, or the edition that was built before."""
    known = built.get(path.resolve())
    if known is not None:
        return known
    edition = _build(reader, parts, problems)
    if not problems:
        built[path.resolve()] = edition
    return edition


def _build(reader: Reader, parts: Parts, problems: list[Problem]) -> Edition:
    spec = language.WholeEdition
    frame = build_frame_format(parts, reader.place, problems)
    types = Types(parts.types, problems)
    robot = build_robot(parts, problems)
    families = with_read_back(
        [
            build_family(family, parts, types, frame.deadline_ms, problems)
            for family in parts.families.values()
            if family.commands
        ],
        robot.encoders.zero if robot.encoders else None,
    )
    observed, seen = build_evidence(parts, problems)
    families = with_disputes(families, observed)
    commands = [command for family in families for command in family.commands]
    return Edition(
        place=reader.place,
        name=reader.get(spec.edition),
        class_name=reader.get(spec.class_),
        title=reader.get(spec.title),
        doc=reader.get(spec.doc),
        document=reader.get(spec.document),
        firmware=reader.get(spec.firmware),
        base=_base_name(reader),
        joints=parts.joints or 0,
        robot=robot,
        frame=frame,
        wires=tuple(types.wires.values()),
        types=tuple(types.types.values()),
        families=families,
        errata=tuple(build_erratum(node, problems) for node in parts.errata),
        vectors=(
            *_inherited(parts, frame, families),
            *seen,
            *(build_vector(node, problems) for node in parts.vectors),
        ),
        changes=tuple(parts.general_changes),
        states=build_state(parts, types, commands, problems),
        gone=tuple(parts.gone.items()),
        bases=(parts.base.name, *parts.base.bases) if parts.base else (),
        root=parts.root,
        observed=observed,
    )


def _inherited(parts: Parts, frame: Frame, families: tuple[Family, ...]) -> Iterator[Vector]:
    """Yield the base's vectors that the delta has not withdrawn."""
    commands = {command.name: command for family in families for command in family.commands}
    acknowledged = {c.name for c in parts.base.commands if c.ack} if parts.base else set()
    for vector, name in parts.inherited:
        assert parts.base is not None, "only a delta inherits"
        after = commands.get(name)
        if (
            vector.direction == "reply"
            and vector.command in acknowledged
            and after is not None
            and not after.replies
        ):
            continue  # The acknowledgement was withdrawn, and its vectors with it.
        yield carried(vector, name, parts.base, frame, commands)


def _base_name(reader: Reader) -> str:
    if reader.record is not language.DeltaEdition:
        return ""
    base = reader.get(language.DeltaEdition.base)
    return base.replace(":", "/").rpartition("/")[2].removesuffix(".yaml")
