"""The catalogue of the test suite: every test case, with a version that changes with them."""

from cobotwire.conformance.catalogue.history import HISTORY, VERSION, CatalogueVersion
from cobotwire.conformance.catalogue.sources import code_digest

__all__ = ["HISTORY", "VERSION", "CatalogueVersion", "code_digest"]
