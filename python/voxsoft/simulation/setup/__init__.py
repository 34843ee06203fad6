"""Setup of a design as a mechanical problem: its parts prepared for the core."""
