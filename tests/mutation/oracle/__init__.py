"""Decide, without a tester, whether a broken device can be distinguished from a correct one."""
