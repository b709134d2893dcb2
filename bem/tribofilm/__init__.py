"""Tribofilms: stress-activated growth, wear, and the substrate worn with them (thesis, paper E)."""
