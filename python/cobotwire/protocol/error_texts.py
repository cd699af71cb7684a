"""Make the texts of errors from ``error_texts.json``, which other languages read too."""

from __future__ import annotations

import os
import re
import sys
from functools import cache
from typing import Any

_PLACEHOLDER = re.compile(r"{(\w+)}")


def error_text(kind: str, **values: object) -> str:
    """Return the text of a kind, with a value instead of each placeholder."""
    # A single substitution does not replace placeholders inside of values.
    text = stored_texts("error_texts.json")[kind]
    return _PLACEHOLDER.sub(lambda found: str(values[found[1]]), text)


@cache
def stored_texts(name: str) -> dict[str, str]:
    """Return the texts of a file beside this module, also from inside a zip file."""
    # Imported here: most programs never need it, and an opened client has loaded it.
    import json

    loader: Any = sys.modules[__name__].__loader__
    found: dict[str, str] = json.loads(
        loader.get_data(os.path.join(os.path.dirname(__file__), name))
    )
    return found
