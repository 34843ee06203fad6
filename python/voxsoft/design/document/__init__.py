"""Design documents: text, formulas and included files resolved to values."""
