"""Runs, studies and calibrations: their processes, what they say, and their folders."""
