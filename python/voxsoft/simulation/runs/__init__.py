"""Runs: one design, a path of designs, many candidates, or step by step under commands."""
