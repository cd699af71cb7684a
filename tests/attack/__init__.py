"""A hostile peer, users of every kind, and a validator that proves which reply each call got."""
