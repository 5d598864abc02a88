"""Ears: sound from a file, a pipe or a microphone, and the words in it."""
