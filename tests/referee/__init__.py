"""Run client libraries against the referee."""
