"""Figures and reports from results. Nothing here solves anything."""
