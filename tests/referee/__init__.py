"""Sessions of client libraries with the referee."""
