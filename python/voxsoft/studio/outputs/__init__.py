"""Output of the studio: files, the page of one body, and pictures."""
