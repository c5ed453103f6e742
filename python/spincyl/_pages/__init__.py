"""Pages that need nothing but a browser: recorded motions, and the core itself to play with."""
