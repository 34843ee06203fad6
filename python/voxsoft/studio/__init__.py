"""The studio: a page in the browser, served by this machine to this machine alone."""
