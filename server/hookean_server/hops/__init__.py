"""Functions for Grasshopper's Hops component."""
