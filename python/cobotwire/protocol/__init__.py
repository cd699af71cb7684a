"""Define what an edition is: records, values, limits, errors. Only this package has these rules."""
