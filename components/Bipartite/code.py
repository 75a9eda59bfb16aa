"""The ends of lines in two groups, so that every line goes from one to the other.

The first end of each connected part is in the first group. A ring of an odd number of lines is an
error: no such groups exist.

Line: one end in each group
"""

from hookean_client import canvas_lines as lines

first, second = lines.bipartite(ghenv, _lines, _tolerance_)
