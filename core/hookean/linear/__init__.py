"""Sparse linear algebra: tangents, factors, aggregation, hierarchies, conjugate gradients."""
