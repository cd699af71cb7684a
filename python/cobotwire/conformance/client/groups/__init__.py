"""The test cases for what a client sends, one small function a group."""
