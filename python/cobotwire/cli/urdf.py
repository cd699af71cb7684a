"""``cobotwire urdf``: write the kinematic model of an arm."""

from __future__ import annotations

import click

from cobotwire import editions
from cobotwire.capture.file_errors import unusable_file
from cobotwire.cli.shared.completers import complete_editions
from cobotwire.cli.shared.output import report_written
from cobotwire.kinematics.urdf_writing import write_urdf


@click.command()
@click.argument("name", metavar="EDITION", shell_complete=complete_editions)
@click.option(
    "-o", "--output", type=click.Path(), default="-", help="A file [default: standard output]."
)
@click.option(
    "--prefix", default="", help="Put this before the name of each link and joint, as in left_j1."
)
def urdf(name: str, output: str, prefix: str) -> None:
    """Write the arm of EDITION as a URDF, if its geometry is known.

    The joints are j1, j2 and so on, with the limits and the highest speed that the edition
    states; the links are base, link1 and so on, and flange. The cylinders show where the links are,
    not how thick they are. Masses and efforts are not known.
    """
    text = write_urdf(editions.load(name).TABLE, prefix)
    try:
        with click.open_file(output, "w", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        raise unusable_file("output", output, error) from error
    if output != "-":
        report_written(output)
