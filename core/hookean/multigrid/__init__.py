"""Algebraic multigrid for the tangent stiffness of large nets: a pattern of 3 x 3 blocks, a hierarchy of ever coarser
nets that serves many shapes, and conjugate gradients that it preconditions.

Source: Vanek, Mandel, Brezina, "Algebraic multigrid by smoothed aggregation", Computing 56 (1996) 179.
"""
