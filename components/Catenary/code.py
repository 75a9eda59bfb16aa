"""The shape of a hanging cable that does not stretch, between two points.

Points are at equal lengths along the exact curve. The lists of A, B, L and G are matched: those
that are shorter repeat their last value. Ends further apart than the cable is long are an error.
Source: Irvine, Cable Structures, 1981, chapter 1.

y = a cosh(x / a), sinh(u) / u = sqrt(L^2 - h^2) / b, u = b / 2a
with b across and h along gravity
"""

from hookean_client import canvas_lines as lines

catenary, points, lines = lines.catenary(ghenv, _start, _end, _length, _gravity_, _count_)
