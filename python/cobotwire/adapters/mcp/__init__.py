"""Offer an arm to language models as tools of the Model Context Protocol (MCP)."""
