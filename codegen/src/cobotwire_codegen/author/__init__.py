"""Tools for whoever writes a spec: explanations, first drafts, what a line shows, editors' help."""
