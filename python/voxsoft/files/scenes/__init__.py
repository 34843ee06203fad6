"""Scenes of other programs: body, objects and drives of a design in one file, MJCF or USD."""
