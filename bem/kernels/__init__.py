"""Influence functions: pure functions, arrays in, arrays out. A kernel knows no solver and no file format."""
