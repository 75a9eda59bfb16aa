"""Endpoints, a file for each family."""
