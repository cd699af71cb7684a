"""Hold what several subcommands share: options, output formats, exit codes."""
