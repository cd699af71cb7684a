"""What all classes of the layer share: opening, orders and queries, results, helpers."""
