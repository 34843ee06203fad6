"""Checks of a design before it is solved, and warnings about a result."""
