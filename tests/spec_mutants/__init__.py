"""Changes every fact of the spec, one at a time, and reports which changes nothing notices."""
