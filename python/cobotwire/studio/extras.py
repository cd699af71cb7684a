"""Import the packages of the web server, or say which extra installs them."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from cobotwire.protocol.errors import UsageError

PAGE = Path(__file__).parent / "page"
# uPlot draws the curves. tools/build_backend.py downloads it for a build, and wheels contain it.
CURVES = PAGE / "vendor" / "uPlot.iife.min.js"


def check_extra() -> None:
    """Check that everything that serves the page is installed.

    Raises:
        UsageError: a package is missing, or the page lacks its library.
    """
    for package in ("starlette", "uvicorn", "websockets"):
        try:
            import_module(package)
        except ImportError as error:
            message = f"cobotwire studio needs {package}: pip install 'cobotwire[studio]'"
            raise UsageError(package, message=message) from error
    if not CURVES.is_file():
        message = (
            "cobotwire studio needs uPlot, which was left out of this package, because the npm "
            "registry could not be reached when it was built; build it again where it can, or "
            "install a released wheel (in a checkout: make front-end)"
        )
        raise UsageError("uPlot", message=message)
