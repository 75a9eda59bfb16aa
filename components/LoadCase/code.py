"""Loads that act together on the form, and changes of temperature.

Loads in a case do not act while the form is found. Connect case to Load Cases, and to Combination
for factors on several of them; the loads need no other wire.

factor x (loads, change of temperature)
"""

from hookean_client import canvas_case_items

case = canvas_case_items.load_case(ghenv, _loads, _factor_, heated_, degrees_, name_)
