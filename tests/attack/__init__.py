"""A hostile peer, users of every kind, and a judge that proves for each call which reply it got."""
