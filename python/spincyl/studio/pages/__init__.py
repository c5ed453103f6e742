"""Pages that need only a browser: recorded motions, and a live page that contains the core."""
