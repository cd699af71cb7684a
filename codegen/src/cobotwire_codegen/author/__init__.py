"""Tools for authors of a spec: explanations, drafts, unknown frames in captures."""
