"""The command line ``voxsoft``: new, check, mesh, run, calibrate, sweep, optimize, export."""

from voxsoft.cli.app import main

__all__ = ["main"]
