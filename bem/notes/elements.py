"""Notes on machine elements."""
