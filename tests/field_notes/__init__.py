"""The behaviour of real serial lines as data, for the tests and ``bench/bad_lines.py``."""
