"""The words in which every mechanism is written."""
