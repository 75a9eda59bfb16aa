"""Definitions run without Grasshopper: stand-ins, data trees, scripts."""
