"""A real client of the Language Server Protocol talks to ``cobotwire-gen lsp`` over stdio."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest
from lsprotocol import types as lsp
from pygls.lsp.client import LanguageClient
from pygls.uris import from_fs_path

import vectors
from codegen.author import samples

SECONDS = 30.0


class Editor:
    """An editor that shows files and sends requests to the server."""

    def __init__(self, client: LanguageClient) -> None:
        self.client = client
        self.published: dict[str, list[lsp.Diagnostic]] = {}
        self.changed = asyncio.Event()
        self.versions: dict[Path, int] = {}

    async def show(self, path: Path, text: str) -> None:
        """Open a file, or change its text, without saving it; wait for its problems."""
        self.changed.clear()
        self.published.pop(uri(path), None)
        version = self.versions[path] = self.versions.get(path, 0) + 1
        if version == 1:
            item = lsp.TextDocumentItem(uri(path), "yaml", version, text)
            self.client.text_document_did_open(lsp.DidOpenTextDocumentParams(item))
        else:
            document = lsp.VersionedTextDocumentIdentifier(version, uri(path))
            whole = lsp.TextDocumentContentChangeWholeDocument(text)
            self.client.text_document_did_change(lsp.DidChangeTextDocumentParams(document, [whole]))
        async with asyncio.timeout(SECONDS):
            while uri(path) not in self.published:
                await self.changed.wait()
                self.changed.clear()

    def problems(self, path: Path) -> list[str]:
        found = self.published[uri(path)]
        return [f"{p.range.start.line + 1}:{p.range.start.character + 1}: {p.code}" for p in found]

    async def hover(self, path: Path, text: str, word: str, after: str = "") -> str:
        where = at(text, word, after)
        document = lsp.TextDocumentIdentifier(uri(path))
        found = await self.client.text_document_hover_async(lsp.HoverParams(document, where))
        if found is None:
            return ""
        assert isinstance(found.contents, lsp.MarkupContent)
        return found.contents.value

    async def complete(self, path: Path, where: lsp.Position) -> list[str]:
        document = lsp.TextDocumentIdentifier(uri(path))
        params = lsp.CompletionParams(document, where)
        found = await self.client.text_document_completion_async(params)
        assert isinstance(found, list)
        return [item.label for item in found]

    async def definition(self, path: Path, text: str, word: str, after: str = "") -> str:
        document = lsp.TextDocumentIdentifier(uri(path))
        params = lsp.DefinitionParams(document, at(text, word, after))
        found = await self.client.text_document_definition_async(params)
        if found is None:
            return ""
        assert isinstance(found, lsp.Location)
        return f"{found.uri.rpartition('/')[2]}:{found.range.start.line + 1}"


def uri(path: Path) -> str:
    return from_fs_path(str(path.resolve())) or ""


def at(text: str, word: str, after: str = "") -> lsp.Position:
    """Return the position of a word's first letter; the word follows ``after``."""
    start = text.index(word, text.index(after))
    return lsp.Position(text[:start].count("\n"), start - (text[:start].rfind("\n") + 1))


@asynccontextmanager
async def editing(root: Path) -> AsyncIterator[Editor]:
    client = LanguageClient("test", "1")
    editor = Editor(client)

    @client.feature(lsp.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)  # type: ignore[untyped-decorator]
    def published(given: lsp.PublishDiagnosticsParams) -> None:
        editor.published[given.uri] = list(given.diagnostics)
        editor.changed.set()

    source = str(vectors.ROOT / "codegen" / "src")
    os.environ["PYTHONPATH"] = source + os.pathsep + os.environ.get("PYTHONPATH", "")
    await client.start_io(sys.executable, "-m", "cobotwire_codegen", "lsp")
    params = lsp.InitializeParams(lsp.ClientCapabilities(), root_uri=uri(root))
    async with asyncio.timeout(SECONDS):
        await client.initialize_async(params)
    client.initialized(lsp.InitializedParams())
    try:
        yield editor
    finally:
        async with asyncio.timeout(SECONDS):
            await client.shutdown_async(None)
            client.exit(None)
            await client.stop()  # type: ignore[no-untyped-call]


async def problems_of_unsaved_text(editor: Editor, folder: Path) -> None:
    lamp = folder / "lamp.yaml"
    text = lamp.read_text()
    await editor.show(lamp, text)
    assert editor.problems(lamp) == []
    broken = text.replace("safety: query", "safety: qery", 1)
    place = at(broken, "qery")
    await editor.show(lamp, broken)
    assert editor.problems(lamp) == [f"{place.line + 1}:{place.character + 1}: unknown-word"]
    await editor.show(lamp, text)
    assert editor.problems(lamp) == []
    assert lamp.read_text() == text


async def hover_completion_and_definition_in_a_delta(editor: Editor, folder: Path) -> None:
    delta = folder / "lamp2.yaml"
    text = delta.read_text()
    await editor.show(delta, text)
    assert editor.problems(delta) == []
    place = "name: angle-reply-2"
    assert "values: The values of the fields" in await editor.hover(delta, text, "values", place)
    shown = await editor.hover(delta, text, "FE", place)
    assert "degrees (raw -15)" in shown
    shown = await editor.hover(delta, text, "get_angle", place)
    assert shown.startswith("```text\nget_angle: ")
    # From the delta to what it uses, changes and removes in its base.
    base = (folder / "lamp.yaml").read_text().splitlines()
    for word, after in (
        *(("get_angle", place), ("set_light", "- change: ")),
        ("read_angle", "- remove: "),
    ):
        goal = await editor.definition(delta, text, word, after)
        assert goal == f"lamp.yaml:{1 + base.index(f'  {word}:')}"

    added = f"{text.partition('commands:')[0]}  - change: get_angle\n    set: {{safety: \n"
    await editor.show(delta, added)
    end = lsp.Position(added.count("\n") - 1, len("    set: {safety: "))
    assert "motion" in await editor.complete(delta, end)
    line = lsp.Position(added.count("\n") - 2, len("  - change: "))
    assert "get_angle" in await editor.complete(delta, line)


def test_server_serves_an_editor(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One server for both parts, since it starts slowly."""
    monkeypatch.setenv("PYTHONPATH", os.environ.get("PYTHONPATH", ""))
    folder = samples.copied(tmp_path)

    async def run() -> None:
        async with editing(folder) as editor:
            await problems_of_unsaved_text(editor, folder)
            await hover_completion_and_definition_in_a_delta(editor, folder)

    asyncio.run(run())
