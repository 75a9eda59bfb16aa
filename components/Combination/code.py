"""Load cases with factors, such as those of a code: 1.35 permanent + 1.5 snow + 0.9 wind.

The factor on prestress multiplies the tensions of the form, the one on permanent the loads that
are in no load case. Connect combination to Load Cases; the cases need no other wire.

sum of factor x load case
"""

from hookean_client import canvas_case_items

combination = canvas_case_items.combination(ghenv, _cases, _factors_, prestress_, permanent_, name_)
