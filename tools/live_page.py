"""Build the page ``live/`` of the website: the studio's page with a source that needs no server."""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import identification_tree
import npm_package
from cobotwire import editions
from cobotwire.conformance.survey.recorded import questions
from cobotwire.editions import Edition, mycobot280
from cobotwire.editions.mycobot280 import MyCobot280
from cobotwire.inspect.readiness import ROLES, problems
from cobotwire.protocol.limits import Limits, limited
from cobotwire.protocol.loading import load_sources
from cobotwire.protocol.refusals import refusals
from cobotwire.protocol.roles import picked, row_index
from cobotwire.protocol.table import Command, Role, Table, Variant
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock
from cobotwire.simulator.start import coordinates
from cobotwire.studio.access import HEADERS
from cobotwire.studio.controls import controls
from cobotwire.studio.explained import about
from cobotwire.studio.extras import CURVES, PAGE
from cobotwire.studio.forms import forms
from cobotwire.studio.robot_facts import robot_facts
from cobotwire.studio.samples import ends_target
from cobotwire_codegen.model import Edition as Model

HERE = npm_package.ROOT / "docs" / "live"
# A <meta> element cannot state frame-ancestors, and WebAssembly needs an extra permission.
POLICY = HEADERS["content-security-policy"].replace("; frame-ancestors 'none'", "")
POLICY = POLICY.replace("script-src 'self'", "script-src 'self' 'wasm-unsafe-eval'")
META = f'<meta http-equiv="Content-Security-Policy" content="{POLICY}; worker-src \'self\'">'
# A raw value that no edition names.
UNNAMED = 173


def facts(edition: Edition) -> dict[str, Any]:
    """Return what the page must know about an edition, as JSON values."""
    table, limits = edition.TABLE, Limits(speed=100)
    refused = refusals(table, limits)
    sources = load_sources(getattr(edition, "__name__", ""))
    asked, left_out = questions(table)
    return {
        "robot": robot_facts(table),
        "controls": controls(limited(table, limits), refused),
        "forms": [form for form in forms(table) if form["name"] not in refused],
        "commands": {each.name: _described(each, sources) for each in table.commands},
        "ready": [_readiness(table, role) for role in ROLES if table.find_role(role)],
        "places": coordinates(table),
        "survey": {
            "questions": [(each.command, dict(each.fields)) for each in asked],
            "leftOut": left_out,
        },
    }


def _described(command: Command, sources: Any) -> dict[str, Any]:
    """Return what explains a command, and where its messages have joints and targets."""
    described: dict[str, Any] = {
        "about": about(command, sources),
        "role": command.role,
        "rows": {"request": _row(command.request), "reply": _row(command.reply)},
        "ends": ends_target(command),
    }
    if command.role == "joint target":
        where, fields = picked(command.request[0]), command.request[0].fields
        described["one"] = [fields[where.picker].name, fields[where.target].name]
    return described


def _row(variants: Sequence[Variant]) -> str:
    rows = [v.fields[row_index(v)].name for v in variants if row_index(v) >= 0]
    return rows[0] if rows else ""


def _readiness(table: Table, role: Role) -> dict[str, Any]:
    """Return the query of a role, and a text for each state in which the arm does not move."""
    query = table.in_role(role)
    field = query.reply[0].fields[-1]

    def text(raw: int) -> str:
        stated: Any = raw
        if role == "powered" and raw > 1:
            # A stand-in for a member of an enum: it is false in a condition.
            stated = type("State", (str,), {"__bool__": lambda _: False})()
            stated.name = field.labels[field.choices.index(raw)]
        found = [f"{each.text}; {each.advice}" for each in problems(table, {role: stated}, "")]
        return "; ".join(found).replace("cobotwire call '' ", "")

    # The texts of values that no source explains differ only in the number.
    usual = "" if field.choices else text(UNNAMED).replace(str(UNNAMED), "{}")
    states = field.choices or range(256)
    texts = {raw: text(raw) for raw in states if text(raw) != usual.replace("{}", str(raw))}
    named = {"role": role, "command": query.name, "field": field.name}
    return {**named, "texts": texts, "usual": usual}


def record_example(path: Path) -> None:
    """Record 8 seconds of an arm that moves; its time is stepped."""
    clock = SteppedClock()
    arm = SimulatedArm(mycobot280.TABLE, clock=clock, powered=True)
    with MyCobot280(MemoryTransport(arm, clock), record=path) as client:
        for step in range(160):
            if step % 40 == 0:
                turned = 60 if step % 80 else -60
                client.send_angles([turned, turned / 2, -turned, 20, 10, turned], 60)
            client.get_angles()
            client.get_coords()
            clock.sleep(1 / 20)


def missing() -> str:
    """Return what the page needs and is missing; empty if nothing is missing."""
    return npm_package.missing() or ("" if CURVES.is_file() else "needs uPlot: make front-end")


def build(folder: Path, found: Callable[[], list[Model]]) -> None:
    """Write the page, or a note of what is missing; ``found`` returns the checked editions."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    if needs := missing():
        text = f"This website was built without the page: it {needs}."
        page = f'<!doctype html><html lang="en"><title>No page</title><p>{text}</p>'
        (folder / "index.html").write_text(page, "utf-8")
        return
    package = npm_package.build(found)
    shutil.copytree(PAGE, folder, dirs_exist_ok=True)
    shutil.copytree(HERE, folder, dirs_exist_ok=True)
    for part, pattern in (("dist", "*.js"), ("dist", "*.wasm"), ("editions", "*.js")):
        (folder / "cobotwire" / part).mkdir(parents=True, exist_ok=True)
        for path in (package / part).glob(pattern):
            shutil.copy(path, folder / "cobotwire" / part)
    page = (folder / "index.html").read_text("utf-8").replace("cobotwire studio", "cobotwire live")
    page = page.replace("<head>", f"<head>\n    {META}", 1).replace("<span>studio", "<span>live")
    (folder / "index.html").write_text(page, "utf-8")
    tables = {name: editions.load(name).TABLE for name in editions.names()}
    (folder / "editions").mkdir(exist_ok=True)
    for name in tables:
        text = json.dumps(facts(editions.load(name)), ensure_ascii=False)
        (folder / "editions" / f"{name}.json").write_text(text, "utf-8")
    titles = {name: table.title for name, table in tables.items()}
    (folder / "editions.json").write_text(json.dumps(titles), "utf-8")
    trees = json.dumps(identification_tree.trees())
    (folder / "identification.json").write_text(trees, "utf-8")
    record_example(folder / "example.pcapng")
    _list_files(folder)


def _list_files(folder: Path) -> None:
    """Tell the service worker which files to keep; it changes if one of them does."""
    worker = folder / "service.js"
    files = sorted(path for path in folder.rglob("*") if path.is_file() and path != worker)
    digest = hashlib.sha256(b"".join(map(Path.read_bytes, files))).hexdigest()[:16]
    names = [path.relative_to(folder).as_posix() for path in files]
    text = worker.read_text("utf-8").replace('"VERSION"', json.dumps(digest))
    worker.write_text(text.replace('["FILES"]', json.dumps(["./", *names])), "utf-8")
