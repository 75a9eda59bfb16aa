"""Straight lines along curves: between points of equal arc length, or the pieces of a polyline.

A count of 0 takes a polyline apart as it is drawn. Lines are chords: along a bent curve they are a
little shorter than its pieces. Several curves in one branch give a branch each.

N lines between N + 1 points at k L / N
"""

from hookean_client import canvas_curves as curves

lines, lengths = curves.shatter(ghenv, _curve, _count_)
