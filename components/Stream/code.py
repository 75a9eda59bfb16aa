"""A motion under a load that follows a table of values through time, such as wind.

The table is a CSV file whose first line names its columns, time [s] among them; a row stands until
the next one, nothing is guessed in between. The motion runs on the server from what is drawn, with
the time step, drag and solver of Settings, and ends with the table.

F(t) = scale x value(t) ^ power on every particle of the load
"""

from hookean_client import canvas_stream

found = canvas_stream.stream(
    ghenv, _forces, anchors_, settings_, geometry_, _file, _column, _force, _scale, _power_, _every_
)
times = found.times
values = found.values
largest = found.largest
geometry = found.geometry
report = found.report
