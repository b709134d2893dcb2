"""Run time against error, and the tables of results that are made again by a command."""
