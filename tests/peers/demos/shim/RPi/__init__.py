"""Stand in for the package of a Raspberry Pi's pins."""
