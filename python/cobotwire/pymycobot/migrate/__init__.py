"""Rewrites programs that were written for the maker's library, to use our clients."""

from cobotwire.pymycobot.migrate.decisions import Decision
from cobotwire.pymycobot.migrate.program import Migrated, migrate

__all__ = ["Decision", "Migrated", "migrate"]
