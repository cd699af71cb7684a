"""Run a test of the maker by pytest, in one process, with what a person types."""

import sys

import pytest

OPTIONS = ["-s", "-q", "--color=no", "--tb=line", "-p", "no:cacheprovider", "-p", "no:warnings"]

sys.exit(pytest.main([*OPTIONS, *sys.argv[1:]]) > 1)
