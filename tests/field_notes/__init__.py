"""What real lines do, as data: the tests and ``bench/bad_lines.py`` play the same cases."""
