"""Decide without any tester whether a broken device can be distinguished from a correct one."""
