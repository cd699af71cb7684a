"""Hold what several verbs share: options, output formats, exit codes."""
