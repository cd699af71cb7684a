"""What an edition is: records, values, limits, errors. The only place that knows these rules."""
