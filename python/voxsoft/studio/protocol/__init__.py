"""What page and server say to each other, and the tabs that it goes to."""
