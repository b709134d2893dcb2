"""Notes on dry contacts, partial slip, flow factors and surface temperatures."""
