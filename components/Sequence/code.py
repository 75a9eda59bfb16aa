"""True in the first solution of a series and False in the next ones, for the reset of an Engine.

It schedules its own solutions and ends after the last frame. Restart begins again when it is let
go.

Frames: 0 (reset), 1, 2 ... to the last
"""

from hookean_client import canvas_drivers as drivers

reset, frame = drivers.sequence(ghenv, _frames_, _restart_, _interval_)
