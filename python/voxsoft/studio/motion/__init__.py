"""The body in motion: its thread and player, its way to rest, the hands on it, and its pictures."""
