"""The text of a design: opened, edited, changed by the page, kept in versions."""
