"""Rhino files (.3dm): read, written, and added to without a change to what they hold."""
