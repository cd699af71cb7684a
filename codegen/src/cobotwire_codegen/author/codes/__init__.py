"""Explain every problem code; ``cobotwire-gen explain CODE`` prints these explanations.

A test fails if the sources emit a code that is not explained here, or if an explained code is never
emitted. It also fails if an example's wrong lines do not cause the code, or its right lines do.
"""

from __future__ import annotations

from cobotwire_codegen.author.codes import arguments, changes, files, messages, proof, types
from cobotwire_codegen.author.codes.explanation import Explanation

__all__ = ["CODES", "Explanation"]

CODES: dict[str, Explanation] = {
    explanation.code: explanation
    for part in (files, types, messages, arguments, proof, changes)
    for explanation in part.EXPLANATIONS
}
