"""``python -m cobotwire_codegen``."""

from cobotwire_codegen.cli import main

main(prog_name="cobotwire-gen")
