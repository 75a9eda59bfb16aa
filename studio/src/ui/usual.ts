// Usual values in the units of a model.
import type { Units } from "../model";

const METRES: Record<string, number> = {
  ...{ m: 1, mm: 1e-3, cm: 1e-2, dm: 0.1, km: 1e3 },
  ...{ in: 0.0254, ft: 0.3048, yd: 0.9144 },
};
const NEWTONS: Record<string, number> = {
  ...{ N: 1, kN: 1e3, MN: 1e6 },
  ...{ kgf: 9.80665, lbf: 4.4482216152605, kip: 4448.2216152605 },
};

const DIGITS = 3;

/** A value in m and kN in the units of a model; its unit in words, as force/length^2. */
export function inUnits(value: number, unit: string, { length, force }: Units): number {
  let factor = 1;
  unit.split("/").forEach((part, i) => {
    const [, name, power] = /^(length|force)(?:\^(\d))?$/.exec(part) ?? [];
    if (!name) return;
    const one = name === "length" ? 1 / (METRES[length] ?? 1) : 1e3 / (NEWTONS[force] ?? 1e3);
    factor *= one ** (Number(power ?? 1) * (i ? -1 : 1));
  });
  return factor === 1 ? value : Number((value * factor).toPrecision(DIGITS));
}

/** Values to begin with, where the schema has none that serves: a cloth of 600 kN/m with 2 kN/m of prestress. */
export function usual(kind: string, units: Units): Record<string, string> {
  const perWidth = (value: number) => String(inUnits(value, "force/length", units));
  if (kind === "membrane") return { warp_stiffness: perWidth(600), prestress: `${perWidth(2)} ${perWidth(2)} 0` };
  return {};
}
