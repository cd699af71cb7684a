"""Prepares the page of a robot: its first program, limits, evidence and commands."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from cobotwire_codegen.facts import SOURCES, Confirmed, bar, counts
from cobotwire_codegen.model import Dispute, Edition, Evidence, Quantity, Value
from cobotwire_codegen.render import Files, environment, python_api
from cobotwire_codegen.render.escape_markdown import escaped
from cobotwire_codegen.render.words import allowed, decimal, lines, units

# The names of sources that report what an arm did.
_REAL_ARM = re.compile(r"\breal arms?\b|\bfield reports?\b|\bcapture\b")
_ABOUT_THE_SPEC = re.compile(r"(?:^| )[^.]*stated as the difference[^.]*\.")


def robot_pages(editions: Sequence[tuple[Edition, Confirmed]]) -> Files:
    """Return a page for each robot; docs/conf.py replaces `<!-- picture -->` with a drawing."""
    template = environment().get_template("markdown/robot.md.j2")
    made: Files = {}
    for given, facts in editions:
        edition, counted = escaped(given), counts(facts)
        text = template.render(
            edition=edition,
            about=_ABOUT_THE_SPEC.sub("", edition.doc),
            own=next((each.name for each in edition.frame.addresses if each.replies == "own"), ""),
            moves=python_api.moves(edition),
            limits=list(_limits(edition)),
            speed=_speed(edition),
            seen=list(_seen(edition)),
            captured=_captured(edition),
            history=_history(edition),
            counted=counted,
            bars=[
                (source, says, bar(counted[source], counted["facts"]))
                for source, says in SOURCES.items()
            ],
            disputed=[command.name for command in edition.commands if command.disputed],
        )
        made[PurePosixPath(f"{edition.name}.md")] = text
    return made


def _limits(edition: Edition) -> Iterator[tuple[str, str]]:
    """Yield each joint and axis with the targets that the edition permits."""
    for name in ("send_angles", "send_coords"):
        command = edition.by_name.get(name)
        for field in command.requests[0] if command else ():
            if isinstance(field.type, Value) and not field.type.varies:
                yield from ((part, _range(item)) for part, item in field.type.items)


def _range(item: object) -> str:
    if not isinstance(item, Quantity) or item.range is None:
        return "no source states a limit"
    lowest, highest = item.range
    return f"{decimal(lowest)} to {decimal(highest)} {units(item.unit)}"


def _speed(edition: Edition) -> str:
    command = edition.by_name.get("send_angles")
    fields = command.requests[0] if command else ()
    return next((allowed(field) for field in fields if field.name == "speed"), "")


def _seen(edition: Edition) -> Iterator[tuple[str, Dispute, str]]:
    """Yield the facts that have a real arm as a source, each with what the arm showed."""
    for thing in (*edition.commands, *edition.types, *edition.wires):
        for dispute in getattr(thing, "disputed", ()):
            shown = [_words(each) for each in dispute.evidence if _REAL_ARM.search(each.source)]
            if shown:
                yield thing.name, dispute, "; ".join(shown)


# What happened to a command with a version of the firmware.
_CHANGES = {"since": "new", "until": "removed", "reply_since": "gets a reply"}


def _history(edition: Edition) -> list[tuple[str, str, str, str]]:
    """Return the known changes of the firmware, by version: version, command, change, source."""
    stated = [(each.name, each.firmware) for each in edition.commands if each.firmware]
    found = sorted(
        (version, name, _CHANGES[key], "; ".join(map(_words, firmware.evidence)))
        for name, firmware in stated
        for key, version in firmware.versions.items()
    )
    return [(f"{float(v):.1f}", name, change, source) for v, name, change, source in found]


def _words(evidence: Evidence) -> str:
    place = f", {lines(evidence.lines)}" if evidence.lines else ""
    return f"{evidence.source}{place}: {evidence.says}"


def _captured(edition: Edition) -> list[str]:
    """Return the commands with a frame that was captured from an arm, each once."""
    found = (v.command for v in edition.vectors if v.name.startswith("captured-"))
    return list(dict.fromkeys(found))
