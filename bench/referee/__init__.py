"""Client libraries before the referee: sessions, and who plays them."""
