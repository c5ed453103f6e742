"""Reading of arguments and writing of numbers: units, words, threads and whole files. No physics."""
