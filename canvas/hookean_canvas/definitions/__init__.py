"""Definitions written: objects, wires, and where they stand."""
