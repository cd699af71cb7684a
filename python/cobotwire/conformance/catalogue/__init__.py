"""The catalogue of the test suite: all test cases, and a version that changes when they do."""

from cobotwire.conformance.catalogue.history import HISTORY, NUMBERS, VERSION, CatalogueVersion

__all__ = ["HISTORY", "NUMBERS", "VERSION", "CatalogueVersion"]
