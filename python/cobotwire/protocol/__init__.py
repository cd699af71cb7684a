"""Define what an edition is: records, values, limits, errors. Nothing else knows these rules."""
