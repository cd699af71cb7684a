"""The catalogue of the test suite: all test cases, and a version that changes when they do."""

from cobotwire.conformance.catalogue.history import HISTORY, VERSION, CatalogueVersion

__all__ = ["HISTORY", "VERSION", "CatalogueVersion"]
