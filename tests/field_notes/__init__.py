"""The behaviour of real lines as data; the tests and ``bench/bad_lines.py`` run the same cases."""
