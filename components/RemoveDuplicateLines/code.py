"""Lines of a branch without duplicates, in either direction.

The first of each kind stays; order and direction of the others are kept.

Same: |a - p| and |b - q|, or |a - q| and |b - p|, at most the tolerance
"""

from hookean_client import canvas_lines as lines

lines = lines.remove_duplicate_lines(ghenv, _lines, _tolerance_)
