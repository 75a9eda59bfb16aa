"""Sparse linear algebra, by what a matrix is made of.

A number for each pair of particles (springs of rest length 0): `laplacian` makes it, `front_cholesky` solves it
exactly, `scalar_cg` by conjugate gradients over the nets of `scalar_hierarchy`.
A block of 3 x 3 for each pair (the tangent of large nets): `tangent_blocks` and `tangent` make it, `block_cg` solves it
over the nets of `block_hierarchy`, with the sums of `block_kernels`; `subsystem` cuts out a part.
A number for each pair of free axes (the tangent of any system): `pattern` and `film_tangent` make it, `sparse_factors`
solves it and counts negative eigenvalues.
Without a matrix: `spring_cg`, from spring to spring. In compiled loops: `profile_cholesky`, for chains.
Both hierarchies are gathered by `aggregation`.
"""
