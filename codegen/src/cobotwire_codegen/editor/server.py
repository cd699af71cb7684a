"""The language server: the Language Server Protocol over stdio. The only importer of pygls."""

from __future__ import annotations

from pathlib import Path

from lsprotocol import types as lsp
from pygls.lsp.server import LanguageServer
from pygls.uris import from_fs_path, to_fs_path

from cobotwire_codegen.editor import complete, lookup
from cobotwire_codegen.editor.workspace import Workspace
from cobotwire_codegen.errors import Place, Problem


def serve(version: str) -> None:
    """Serve one editor over stdin and stdout until it disconnects."""
    make_server(version).start_io()


def make_server(version: str) -> LanguageServer:
    """Return the server with its features."""
    server = LanguageServer("cobotwire-gen", version)
    specs = _Specs(server)

    @server.feature(lsp.TEXT_DOCUMENT_DID_OPEN)
    def opened(given: lsp.DidOpenTextDocumentParams) -> None:
        specs.changed(given.text_document.uri)

    @server.feature(lsp.TEXT_DOCUMENT_DID_CHANGE)
    def changed(given: lsp.DidChangeTextDocumentParams) -> None:
        specs.changed(given.text_document.uri)

    @server.feature(lsp.TEXT_DOCUMENT_DID_CLOSE)
    def closed(given: lsp.DidCloseTextDocumentParams) -> None:
        specs.closed(given.text_document.uri)

    @server.feature(lsp.TEXT_DOCUMENT_HOVER)
    def hover(given: lsp.HoverParams) -> lsp.Hover | None:
        path, line, column = specs.position(given.text_document.uri, given.position)
        text = lookup.hover(specs.workspace, path, line, column)
        code = lsp.MarkupContent(lsp.MarkupKind.Markdown, f"```text\n{text}\n```")
        return lsp.Hover(code) if text else None

    @server.feature(
        lsp.TEXT_DOCUMENT_COMPLETION, lsp.CompletionOptions(trigger_characters=[" ", "{", ","])
    )
    def completion(given: lsp.CompletionParams) -> list[lsp.CompletionItem]:
        path, line, column = specs.position(given.text_document.uri, given.position)
        text = specs.workspace.text(path)
        found = complete.completions(specs.workspace.edition(path), text, line, column)
        return [_item(each) for each in found]

    @server.feature(lsp.TEXT_DOCUMENT_DEFINITION)
    def definition(given: lsp.DefinitionParams) -> lsp.Location | None:
        path, line, column = specs.position(given.text_document.uri, given.position)
        try:
            file, place = lookup.definition(specs.workspace, path, line, column)
        except LookupError:
            return None
        return lsp.Location(from_fs_path(str(file)) or "", specs.range(file, place))

    return server


def _item(found: complete.Completion) -> lsp.CompletionItem:
    kind = lsp.CompletionItemKind.Property if found.is_key else lsp.CompletionItemKind.Value
    text = f"{found.label}: " if found.is_key else found.label
    return lsp.CompletionItem(found.label, kind=kind, detail=found.doc or None, insert_text=text)


class _Specs:
    """The workspace of one editor, in the editor's own terms: URIs and UTF-16 positions."""

    def __init__(self, server: LanguageServer) -> None:
        self._server = server
        self._workspace: Workspace | None = None

    @property
    def workspace(self) -> Workspace:
        """The specs in the folder that the editor opened."""
        if self._workspace is None:
            self._workspace = Workspace(Path(self._server.workspace.root_path or "."))
        return self._workspace

    def changed(self, uri: str) -> None:
        """Take the text that the editor shows now; publish the problems of its editions."""
        document = self._server.workspace.get_text_document(uri)
        path = Path(document.path).resolve()
        self.workspace.unsaved[path] = document.source
        self._publish(path)

    def closed(self, uri: str) -> None:
        """Forget the text that the editor showed; the file on disk counts again."""
        path = _path(uri)
        self.workspace.unsaved.pop(path, None)
        self._publish(path)

    def _publish(self, path: Path) -> None:
        for file, problems in self.workspace.problems(path).items():
            found = [self._diagnostic(file, problem) for problem in problems]
            uri = from_fs_path(str(file)) or ""
            self._server.text_document_publish_diagnostics(
                lsp.PublishDiagnosticsParams(uri=uri, diagnostics=found)
            )

    def _diagnostic(self, file: Path, problem: Problem) -> lsp.Diagnostic:
        return lsp.Diagnostic(
            self.range(file, problem.place),
            problem.message,
            severity=lsp.DiagnosticSeverity.Error,
            code=problem.code,
            source="cobotwire-gen",
        )

    def position(self, uri: str, position: lsp.Position) -> tuple[Path, int, int]:
        """Return the file, the line and the column, in code points from 0, of a position."""
        path = _path(uri)
        line = self._line(path, position.line)
        units = line.encode("utf-16-le")[: 2 * position.character]
        return path, position.line, len(units.decode("utf-16-le", "ignore"))

    def range(self, file: Path, place: Place) -> lsp.Range:
        """Return the range from a place to the end of its word."""
        line = self._line(file, place.line - 1)
        word = lookup.word_at(line, 0, place.column - 1)
        ends = place.column - 1, place.column - 1 + max(len(word), 1)
        start, end = (
            lsp.Position(place.line - 1, len(line[:column].encode("utf-16-le")) // 2)
            for column in ends
        )
        return lsp.Range(start, end)

    def _line(self, file: Path, line: int) -> str:
        try:
            lines = self.workspace.text(file).split("\n")
        except (OSError, UnicodeDecodeError):
            return ""
        return lines[line] if line < len(lines) else ""


def _path(uri: str) -> Path:
    return Path(to_fs_path(uri) or "").resolve()
