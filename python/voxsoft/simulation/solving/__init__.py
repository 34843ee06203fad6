"""Solution methods, their settings, and the choice between them."""
