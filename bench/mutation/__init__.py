"""How good are the testers? Subjects broken on purpose, and how many of them are found."""
