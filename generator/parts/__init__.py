"""One builder per part family: frozen numbers in, one valid solid out."""
