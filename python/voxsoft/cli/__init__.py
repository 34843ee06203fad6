"""The command line ``voxsoft``: new, check, mesh, run, calibrate, material, sweep, ..."""

from voxsoft.cli.app import main

__all__ = ["main"]
