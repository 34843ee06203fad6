"""Runs, studies and calibrations: their processes, events, and folders."""
