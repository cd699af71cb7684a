"""Define what an edition is: records, values, limits, errors. No other package implements these
rules."""
