"""What real arms showed: reading the files of owners, and counting what is confirmed."""
