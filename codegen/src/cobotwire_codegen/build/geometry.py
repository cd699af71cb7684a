"""Builds the geometry of an arm."""

from __future__ import annotations

from cobotwire_codegen import language
from cobotwire_codegen.build.parts import Parts
from cobotwire_codegen.errors import Problem
from cobotwire_codegen.load import Node
from cobotwire_codegen.model import Geometry, Link, Motion
from cobotwire_codegen.reader import Reader


def build_geometry(parts: Parts, problems: list[Problem]) -> Geometry | None:
    """Return the geometry of an edition; None if it states none."""
    if parts.geometry is None:
        return None
    spec = language.Geometry
    reader = Reader(parts.geometry, spec, "the geometry", problems)
    links = tuple(_link(node, problems) for node in reader.get(spec.links))
    signs = reader.get(spec.encoder_signs)
    built = Geometry(links, signs, reader.get(spec.doc))
    joints = parts.joints or 0
    if not len(links) == len(signs) == joints or set(signs) - {1, -1}:
        message = f"the geometry must have a link, and a sign 1 or -1, for each of {joints} joints"
        reader.problem("bad-number", message)
    return built


def build_motion(parts: Parts, problems: list[Problem]) -> Motion | None:
    """Return how the arm of an edition moves; None if it does not state it."""
    if parts.motion is None:
        return None
    spec = language.Motion
    reader = Reader(parts.motion, spec, "the motion", problems)
    speed, fastest, acceleration = map(reader.get, (spec.speed, spec.fastest, spec.acceleration))
    if min(speed, fastest, acceleration) <= 0:
        reader.problem("bad-number", "the numbers of the motion must be above 0")
    return Motion(speed, fastest, acceleration, reader.get(spec.doc))


def _link(node: Node, problems: list[Problem]) -> Link:
    spec = language.Link
    reader = Reader(node, spec, "a link of the geometry", problems)
    return Link(*(reader.get(key) for key in (spec.offset, spec.alpha, spec.a, spec.d)))
