"""The process behind the page: its web application and security, and the session of all tabs."""
