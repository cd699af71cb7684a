"""Compare the decoder page's script, run in a browser, with every vector."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import vectors
from cobotwire_codegen.targets.decoder import edition_script
from targets.comparison import Comparison, compared
from targets.decoder import browser
from targets.vectors.comparison import Record, read
from vectors import ROOT

SCRIPTS = ROOT / "docs" / "_static" / "decoder"
HARNESS = Path(__file__).with_name("harness.js")
RESULT = "document.getElementById('result').textContent"


def compare(edition: str) -> Comparison:
    """Compare every vector of an edition.

    Raises:
        ToolMissing: Chromium is not installed.
    """
    return validated(read(edition), edition_script(vectors.edition(edition)))


def validated(document: Record, table: str) -> Comparison:
    """Run a document's messages, malformed bytes and streams with a table's script."""
    [found] = compare_all([(document, table)])
    return found


def compare_all(documents: Sequence[tuple[Record, str]]) -> list[Comparison]:
    """Run several documents, each with the script of its table, in one browser."""
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "harness.html"
        page.write_text(_page(documents), encoding="utf-8")
        [written] = browser.evaluate(page.as_uri(), RESULT)
    made = json.loads(written)
    return [_compared(document, each) for (document, _), each in zip(documents, made, strict=True)]


def _compared(document: Record, found: Any) -> Comparison:
    comparers = {"messages": _message, "malformed": _malformed, "streams": _stream}
    made = {part: iter(found[part]) for part in comparers}

    def compare(part: str, record: Record) -> Iterator[str]:
        return comparers[part](record, next(made[part]))

    return compared(document, {part: partial(compare, part) for part in comparers})


def _page(documents: Sequence[tuple[Record, str]]) -> str:
    scripts = [
        *((SCRIPTS / f"{name}.js").read_text() for name in ("values", "law", "table")),
        *(table for _, table in documents),
        f"const cobotwireVectors = {json.dumps([document for document, _ in documents])};",
        HARNESS.read_text(),
    ]
    body = "".join(f"<script>{script}</script>" for script in scripts)
    return f'<!doctype html><meta charset="utf-8"><body>{body}</body>'


def _message(record: Record, made: Any) -> Iterator[str]:
    # JavaScript writes raw values as texts: raw values of floats may have 64 bits.
    fields = [
        {key: f[key] for key in ("name", "value", "text") if key in f}
        | {"raw": list(map(str, f["raw"]))}
        for f in record["fields"]
    ]
    # The bytes may decode as another command with the same id. Then only that command is reported.
    if "error" in made or made["read_as"] != record["read_as"]:
        yield f"{made}, not read as {record['read_as']}"
    elif made.get("fields") != fields:
        yield f"{made.get('fields')}, not {fields}"


def _malformed(record: Record, made: Any) -> Iterator[str]:
    right = {"reason": record["reason"], "offset": record["offset"]}
    if made != right:
        yield f"{made}, not {right}"


def _stream(record: Record, made: Any) -> Iterator[str]:
    if made != record["events"]:
        yield f"{made}, not {record['events']}"
