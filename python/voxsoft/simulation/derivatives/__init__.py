"""Derivatives of metrics at an equilibrium and along a path."""
