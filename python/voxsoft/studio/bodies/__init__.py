"""Bodies on the page: surfaces, objects, tendons, places, and numbers of their state."""
