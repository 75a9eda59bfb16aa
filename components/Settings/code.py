"""How the engine runs: merging of points, time steps, floor, drag, solver, units.

Every input may be left out. The solvers verlet and yoshida move in physical time with a step;
relaxation and newton only look for the equilibrium.

x(t + dt) = x + v dt + F dt^2 / (2 m)
"""

from hookean_client import canvas

settings = canvas.settings(
    ghenv,
    weld_tolerance=_tolerance_,
    time_step=_time_step_,
    sub_iterations=_sub_iterations_,
    floor=_floor_,
    drag=_drag_,
    solver=_solver_,
    tolerance=_residual_,
    length=_length_unit_,
    force=_force_unit_,
    time=_time_unit_,
    fast=_fast_,
    allow_unstable=_allow_unstable_,
    all_particles=_all_particles_,
)
