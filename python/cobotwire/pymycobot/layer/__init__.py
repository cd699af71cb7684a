"""The layer of classes with the maker's names over our clients, and what they share."""
