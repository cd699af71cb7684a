"""What all classes of the layer share: opening, requests, results, helpers."""
