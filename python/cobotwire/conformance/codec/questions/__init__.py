"""The questions to every codec of an edition, derived from the edition's table."""
