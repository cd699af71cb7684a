"""Targets: what else the model becomes, for other people's tools. A folder each."""
