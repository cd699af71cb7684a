"""The test cases for what a client sends, one small function for each group."""
