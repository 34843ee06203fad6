"""What the page shows of a body: surfaces, objects, tendons, places, and what is known of it."""
