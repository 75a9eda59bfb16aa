"""Definitions made for Kangaroo as definitions for hookean."""
