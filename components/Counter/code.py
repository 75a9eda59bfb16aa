"""Counts solutions of the canvas: 0 while reset is True, then one more for each solution.

A timer, the Engine upstream or a changed input solve it; with an interval it schedules its own
solutions. It does not stop by itself then.

Count = solutions since reset
"""

from hookean_client import canvas_drivers as drivers

count = drivers.counter(ghenv, _reset_, _interval_)
