"""Compares editions: models, not text.

Every difference is a finding of one rule; a rule has a level, and from the levels follows the
version bump.
"""

from cobotwire_codegen.diff.editions import diff, diff_all
from cobotwire_codegen.diff.finding import Finding, breaking, bump, bump_before_1_0
from cobotwire_codegen.diff.rules import LEVELS, RULES

__all__ = [
    "LEVELS",
    "RULES",
    "Finding",
    "breaking",
    "bump",
    "bump_before_1_0",
    "diff",
    "diff_all",
]
