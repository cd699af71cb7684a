"""Let the search of the site find commands by what they do, in the words of users."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping

from docutils import nodes
from sphinx import addnodes
from sphinx.search.en import SearchEnglish

from cobotwire_codegen.model import Command

# Words that users write, with the words of these pages.
SAME = {"color": "colour", "led": "light", "wifi": "network", "drag": "hand"}
# A name is split at underscores and before a number: "Pro450" is found by "pro 450".
NUMBERED = "[a-z]{3,}(?=[0-9]{3})"


class UserWords(SearchEnglish):
    """Splits the text of pages and the query of a reader into the same words."""

    _word_re = re.compile(rf"{NUMBERED}|[^\W_]+", re.IGNORECASE)
    js_splitter_code = f"""
const SAME = {json.dumps(SAME)};
var splitQuery = (query) =>
  (query.match(/{NUMBERED}|[\\p{{L}}\\p{{N}}]+/giu) ?? [])
    .map((word) => SAME[word.toLowerCase()] ?? word);
"""

    def split(self, input: str) -> list[str]:
        """Return the words of a text."""
        return [SAME.get(word.lower(), word) for word in super().split(input)]


def name_commands(document: nodes.document, commands: Mapping[str, Command]) -> None:
    """Add to the index what each command does; those with a role are main entries."""
    for section in document.findall(nodes.section):
        if command := commands.get(section[0].astext()):
            text = f"{command.title} | {command.doc}".replace(";", ",")
            main = "main" if command.role else ""
            entry = ("single", text, section["ids"][0], main, None)
            section.insert(1, addnodes.index(entries=[entry]))
