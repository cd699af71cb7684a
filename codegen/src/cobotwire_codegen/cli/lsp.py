"""``cobotwire-gen lsp``: help an editor with specs."""

from __future__ import annotations

from importlib.metadata import version

import click


@click.command()
def lsp() -> None:
    """Run a language server for editors, over stdin and stdout.

    It shows problems while a spec is typed, explains vectors byte by byte and names on hover,
    completes keys, words and names, and leads from a delta to what it changes in its base.

    It needs pygls: pip install 'cobotwire-codegen[lsp]'.
    """
    try:
        from cobotwire_codegen.editor.server import serve
    except ModuleNotFoundError as error:
        if error.name not in ("pygls", "lsprotocol"):
            raise
        message = "the language server needs pygls: pip install 'cobotwire-codegen[lsp]'"
        raise click.ClickException(message) from None
    serve(version("cobotwire-codegen"))
