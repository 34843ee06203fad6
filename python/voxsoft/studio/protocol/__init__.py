"""Messages between page and server, and the tabs that receive them."""
