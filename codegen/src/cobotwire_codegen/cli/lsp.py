"""``cobotwire-gen lsp``: help an editor with specs."""

from __future__ import annotations

from importlib.metadata import version

import click


@click.command()
def lsp() -> None:
    """Run a language server for editors, over stdin and stdout.

    It shows problems while a spec is typed. On hover it explains names, and vectors byte by byte.
    It completes keys, words and names, and jumps from a delta to the changed part of its base.

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
