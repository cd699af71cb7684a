"""What every problem code means: the registry behind ``cobotwire-gen explain CODE``.

A code that the sources emit and that is not explained here, or the other way round, fails a test;
so does an example whose wrong lines do not give the code, or whose right lines do.
"""

from __future__ import annotations

from cobotwire_codegen.author.codes import changes, files, messages, proof, types
from cobotwire_codegen.author.codes.explanation import Explanation

__all__ = ["CODES", "Explanation"]

CODES: dict[str, Explanation] = {
    explanation.code: explanation
    for part in (files, types, messages, proof, changes)
    for explanation in part.EXPLANATIONS
}
