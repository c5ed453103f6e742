"""What comes in, and what goes out as text: numbers, units, words, threads and whole files. No physics."""
