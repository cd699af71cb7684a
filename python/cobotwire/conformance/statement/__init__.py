"""Implementation conformance statements: what a maker declares that a device has, and lacks."""

from cobotwire.conformance.statement.reader import load_statement, read_statement
from cobotwire.conformance.statement.statement import (
    Acknowledgements,
    Statement,
    Support,
    is_mandatory,
    statement_template,
    with_deadlines,
    without,
)

__all__ = [
    "Acknowledgements",
    "Statement",
    "Support",
    "is_mandatory",
    "load_statement",
    "read_statement",
    "statement_template",
    "with_deadlines",
    "without",
]
