"""Symmetric bodies: the solved sector, its parts, and its mirror images."""
