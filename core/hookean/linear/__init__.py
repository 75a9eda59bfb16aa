"""Sparse linear algebra, grouped by the entries of a matrix.

- One number for each pair of particles (springs of rest length 0): `laplacian` assembles it, `front_cholesky` is the
  direct solver, `scalar_cg` with `scalar_hierarchy` the iterative one.
- One block of 3 x 3 for each pair (the tangent of a large net): `tangent_blocks` and `tangent` assemble it, `block_cg`
  with `block_hierarchy` and `block_kernels` solves it, `subsystem` extracts a part of a system.
- One number for each pair of free axes (the tangent of any system): `pattern` and `film_tangent` assemble it,
  `sparse_factors` solves it and counts negative eigenvalues; `directions` puts another in its place where lines vanish.
- `spring_cg` works on springs without a matrix, `profile_cholesky` inside compiled loops on chains.

Both hierarchies use `aggregation`. SciPy's sparse matrices load without what of NumPy they do not use (`put_off`).
"""

from hookean.linear.put_off import NUMPY, put_off

put_off("numpy", NUMPY)
