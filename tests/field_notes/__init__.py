"""The behaviour of real lines as data, for the tests and ``bench/bad_lines.py``."""
