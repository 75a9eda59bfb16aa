"""Recipes: what the objects of a .3dm file stand for."""
