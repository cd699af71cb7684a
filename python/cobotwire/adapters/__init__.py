"""Connect arms to the systems that other people use; each system has a folder of its own."""
