"""Types of the private Rust module."""

__version__: str
