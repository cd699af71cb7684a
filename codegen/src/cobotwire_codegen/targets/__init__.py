"""Output targets for other tools, a folder each."""
