// A view from a file or an address, which any program may have written: what is invalid is left out and named.
import { placed } from "../view/memory";
import { steps, summed } from "../view/steps";
import type { Groups, Kept } from "../view/types";
import { isProblem } from "./designing";
import { chosenOf } from "./surfacing";

const COLOURINGS = ["force", "strain", "plain", "given"];
const SCALES = ["auto", "even", "log"];

type Told = Record<string, unknown>;

/** What each part is called, and whether a value is valid for a model with so many particles. */
const PARTS: { [name in keyof Kept]-?: [string, (told: unknown, particles: number) => boolean] } = {
  eye: ["camera", (told) => Array.isArray(told) && placed(told) !== null],
  colouring: ["colouring", (told) => COLOURINGS.includes(String(told))],
  scale: ["colour scale", (told) => isOf(told, () => true) && isScale(told as Told)],
  groups: ["groups", (told, particles) => isOf(told, (group) => isSet(group, particles))],
  groupColours: ["colours of groups", (told) => isOf(told, (colour) => /^#[0-9a-f]{6}$/i.test(String(colour)))],
  layers: ["layers", (told) => isOf(told, (is) => typeof is === "boolean")],
  picked: ["picked element", (told, particles) => isOf(told, () => true) && isPicked(told as Told, particles)],
  marked: ["selection", isSet],
  surface: ["surface", (told) => isOf(told, () => true) && chosenOf(told) !== null],
  design: ["design problem", isProblem],
  recipe: ["recipe", (told) => isOf(told, (text) => typeof text === "string") && isRecipe(told as Told)],
};

/** What is valid of a view, and a sentence on the rest; "" for nothing. */
export function checked(told: unknown, from: string, particles = Infinity): { view: Kept; note: string } {
  const view: Partial<Record<keyof Kept, unknown>> = {};
  const wrong: string[] = [];
  const given = isOf(told, () => true) ? unstepped(told as Told) : {};
  for (const [name, [said, is]] of Object.entries(PARTS) as [keyof Kept, (typeof PARTS)[keyof Kept]][]) {
    const value = given[name];
    if (value === undefined || value === null) continue;
    if (is(value, particles)) view[name] = value;
    else wrong.push(said);
  }
  const names = wrong.join(", ");
  const note = `The view in the ${from} has invalid values, which were left out: ${names}. The model is whole.`;
  return { view: view as Kept, note: wrong.length ? note : "" };
}

/** The view with its sets of particles as differences, which take a third of the room when compressed. */
export function stepped(view: Kept): object {
  const { groups, marked, ...rest } = view;
  const kept = groups && Object.fromEntries(Object.entries(groups).map(([name, set]) => [name, steps(set)]));
  return { ...rest, steps: { ...(kept && { groups: kept }), ...(marked && { marked: steps(marked) }) } };
}

function unstepped({ steps: told, ...view }: Told): Told {
  const { groups, marked } = (told ?? {}) as Told;
  const sums = (set: unknown) => (Array.isArray(set) ? summed(set as number[]) : set);
  const found: Told = { ...view };
  if (isOf(groups, () => true))
    found["groups"] = Object.fromEntries(Object.entries(groups as Groups).map(([name, set]) => [name, sums(set)]));
  if (marked !== undefined) found["marked"] = sums(marked);
  return found;
}

const isOf = (told: unknown, is: (value: unknown) => boolean): boolean =>
  typeof told === "object" && told !== null && !Array.isArray(told) && Object.values(told).every(is);

function isSet(told: unknown, particles: number): boolean {
  return Array.isArray(told) && told.every((one) => Number.isInteger(one) && one >= 0 && one < particles);
}

function isPicked({ kind, index }: Told, particles: number): boolean {
  return isSet([index], kind === "particle" ? particles : Infinity) && (kind === "particle" || kind === "spring");
}

const isScale = ({ kind, low, high }: Told) => SCALES.includes(String(kind)) && isEnd(low) && isEnd(high);
const isEnd = (told: unknown) => told === null || told === undefined || Number.isFinite(told);
const isRecipe = ({ file, text }: Told) => file !== undefined && text !== undefined;
