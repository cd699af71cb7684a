"""Run a test of the maker by pytest, in one process, with what a person types."""

import sys

import pytest

sys.exit(pytest.main(["-s", "-q", "-p", "no:cacheprovider", "--tb=line", *sys.argv[1:]]) > 1)
