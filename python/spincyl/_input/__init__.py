"""Reading of arguments and writing of numbers and files: units, words, threads. No physics."""
