"""Floor: a plane that particles cannot pass, with rebound and dry friction."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import model_validator

from hookean.forces.base import Block, Floats, Force, Places
from hookean.values.columns import Vector, fault
from hookean.values.fields import Field


def floor_impact(x_before, v_before, acceleration, x, v, free, dt, parameters):  # type: ignore[no-untyped-def]
    # v is the velocity at half step; the path inside a step is x + v t + a t^2 / 2, so free fall bounces exactly
    for p in range(parameters.shape[0]):
        for i in range(x.shape[0]):
            depth = 0.0
            for c in range(3):
                depth += (x[i, c] - parameters[p, c]) * parameters[p, 3 + c]
            if depth >= 0.0:
                continue
            reach = 0.0
            for c in range(3):
                n = parameters[p, 3 + c]
                reach += n * n * free[i, c]
            if reach < 1e-12:
                continue
            height = 0.0
            speed = 0.0
            pull = 0.0
            for c in range(3):
                n = parameters[p, 3 + c]
                height += (x_before[i, c] - parameters[p, c]) * n
                speed += v_before[i, c] * n
                pull += acceleration[i, c] * n
            rebound = 0.0
            rest = 0.0
            if dt > 0.0 and height > 0.0:
                # time of impact: height + speed t + pull t^2 / 2 = 0, smallest positive root
                root = np.sqrt(np.maximum(speed * speed - 2.0 * pull * height, 0.0))
                time = 2.0 * height / (root - speed) if root > speed else dt
                time = np.minimum(np.maximum(time, 0.0), dt)
                hit = speed + pull * time
                rest = dt - time
                if hit < 0.0:
                    rebound = -parameters[p, 6] * hit
                    jump = rebound - hit
                    slip = 0.0
                    for c in range(3):
                        n = parameters[p, 3 + c]
                        along = v_before[i, c] + acceleration[i, c] * time - hit * n
                        slip += along * along
                    slip = np.sqrt(slip)
                    if slip > 0.0:
                        kept = np.maximum(1.0 - parameters[p, 8] * jump / slip, 0.0) - 1.0
                        for c in range(3):
                            n = parameters[p, 3 + c]
                            along = v_before[i, c] + acceleration[i, c] * time - hit * n
                            x[i, c] += kept * along * rest * free[i, c]
                            v[i, c] += kept * along * free[i, c]
            after = rebound * rest + 0.5 * pull * rest * rest
            normal_v = 0.0
            depth = 0.0
            for c in range(3):
                n = parameters[p, 3 + c]
                normal_v += v[i, c] * n
                depth += (x[i, c] - parameters[p, c]) * n
            if rebound > 0.0 and after > 0.0:
                lift = after - depth
                kick = rebound + pull * (rest - 0.5 * dt) - normal_v
            else:
                lift = -depth
                kick = -normal_v if normal_v < 0.0 or dt > 0.0 else 0.0
            for c in range(3):
                n = parameters[p, 3 + c] * free[i, c] / reach
                x[i, c] += lift * n
                v[i, c] += kick * n


def floor_support(x, v, f, carried, free, mass, dt, parameters):  # type: ignore[no-untyped-def]
    # what rests on the floor: the floor carries the pressing force, and the tangential one up to friction
    for p in range(parameters.shape[0]):
        for i in range(x.shape[0]):
            depth = 0.0
            size = 0.0
            for c in range(3):
                n = parameters[p, 3 + c]
                depth += (x[i, c] - parameters[p, c]) * n
                size += np.abs(x[i, c] * n) + np.abs(parameters[p, c] * n)
            if depth > 1e-14 * size:
                continue
            press = 0.0
            speed = 0.0
            reach = 0.0
            for c in range(3):
                n = parameters[p, 3 + c]
                press -= f[i, c] * n * free[i, c]
                speed += v[i, c] * n
                reach += n * n * free[i, c]
            if press <= 0.0 or reach < 1e-12:
                continue
            rest = dt * press / mass[i] if dt > 0.0 else 0.0
            if dt > 0.0 and speed > rest:
                continue
            press /= reach
            slip = 0.0
            shear = 0.0
            going = 0.0  # momentum at the end of the step if nothing slowed it down
            for c in range(3):
                n = parameters[p, 3 + c]
                along = (v[i, c] - speed * n) * free[i, c]
                slip += along * along
                f[i, c] += press * n * free[i, c]
                carried[i, c] += press * n
                v[i, c] -= speed * n * free[i, c] / reach
                shear += f[i, c] * f[i, c] * free[i, c]
                ahead = (mass[i] * v[i, c] + dt * f[i, c]) * free[i, c]
                going += ahead * ahead
            slip = np.sqrt(slip)
            shear = np.sqrt(shear)
            going = np.sqrt(going)
            held = parameters[p, 7] * press
            slows = parameters[p, 8] * press
            moves = dt > 0.0 and slip > 0.0
            if moves and slip * mass[i] > (slows + shear) * dt:
                for c in range(3):
                    n = parameters[p, 3 + c]
                    brake = -slows * v[i, c] * free[i, c] / slip
                    f[i, c] += brake
                    carried[i, c] += brake
            elif moves and going > slows * dt:
                # static friction holds only what has stopped: damping may hide a shear that it could not hold at rest
                for c in range(3):
                    brake = -slows * (mass[i] * v[i, c] + dt * f[i, c]) * free[i, c] / going
                    f[i, c] += brake
                    carried[i, c] += brake
            elif shear <= held:
                for c in range(3):
                    carried[i, c] -= f[i, c] * free[i, c]
                    f[i, c] -= f[i, c] * free[i, c]
                    v[i, c] -= v[i, c] * free[i, c]
            elif shear > 0.0:
                part = (slows if dt > 0.0 else held) / shear
                for c in range(3):
                    brake = -part * f[i, c] * free[i, c]
                    f[i, c] += brake
                    carried[i, c] += brake


class Floor(Force):
    """A plane no particle passes: rebound with `restitution`, dry (Coulomb) friction.

    A particle that hits with normal speed u leaves with e u, so a ball dropped from h rises to h e^2; one that rests
    is carried with N >= 0 and held sideways up to mu_s N, and slides against mu_k N, with mu_k <= mu_s. Classic
    Kangaroo's friction numbers have no published formula; the friction coefficients here are ours.
    """

    kind: Literal["floor"] = "floor"
    point: Vector = Field(default=np.zeros(3), description="A point of the plane [length]")
    normal: Vector = Field(
        default=np.array([0.0, 0.0, 1.0]), description="Direction to the free side; its length is ignored"
    )
    restitution: float = Field(default=0.7, ge=0, le=1, description="Part of the speed kept in a rebound [-]")
    static_friction: float = Field(default=0.6, ge=0, le=1e12, description="mu_s [-]: holds up to mu_s N")
    kinetic_friction: float = Field(
        default=0.5, ge=0, le=1e12, description="mu_k [-]: slides against mu_k N; at most mu_s"
    )

    formula: ClassVar[str] = "N ≥ 0, |T| ≤ μ N"
    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    conservative: ClassVar[bool] = False
    remembers: ClassVar[bool] = False
    impact: ClassVar[Any] = staticmethod(floor_impact)
    support: ClassVar[Any] = staticmethod(floor_support)

    @model_validator(mode="after")
    def _has_a_side(self) -> Floor:
        if not np.linalg.norm(self.normal) > 0:
            raise fault("the normal must not be zero", "/normal")
        return self

    @model_validator(mode="after")
    def _slides_with_less(self) -> Floor:
        held, slides = self.static_friction, self.kinetic_friction
        if slides > held and "kinetic_friction" in self.model_fields_set:
            said = f"{slides:g} given, above the static friction, {held:g}; lower it, or raise static_friction"
            raise fault(said, "/kinetic_friction")
        if slides > held:  # the default, for a floor that is smoother than most
            object.__setattr__(self, "kinetic_friction", held)
        return self

    def compile(self, places: Places) -> Block:
        """One row for the plane: point, unit normal, restitution, static and kinetic friction."""
        unit = np.asarray(self.normal) / np.linalg.norm(self.normal)
        return Block.of(
            np.zeros((1, 1)),
            point=np.asarray(self.point)[None],
            normal=unit[None],
            restitution=self.restitution,
            static_friction=self.static_friction,
            kinetic_friction=self.kinetic_friction,
        )

    @classmethod
    def example(cls) -> tuple[Floor, Floats]:
        """The XY plane with one particle above it."""
        return cls(), np.array([[0.0, 0.0, 0.5]])
