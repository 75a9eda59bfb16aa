"""Grasshopper files without Grasshopper: archives read and written, components built, definitions run and imported."""
