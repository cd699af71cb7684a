"""Break subjects on purpose, and count how many of them the conformance testers find."""
