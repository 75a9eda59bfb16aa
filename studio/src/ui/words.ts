// Numbers and units in words.
import type { Units } from "../model";

/** A number as people read it, with so many digits that count; whole ones have all of theirs. */
export function said(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return "-";
  const size = Math.abs(value);
  if (Number.isInteger(value) && size < 1e9) return String(value);
  if (size >= 1e6 || size < 1e-4) return Number(value.toPrecision(Math.max(1, digits - 1))).toExponential();
  return String(Number(value.toPrecision(digits)));
}

const POWERS: Record<string, string> = { "2": "²", "3": "³", "4": "⁴" };

/** A unit of the catalogue, such as force/length, in those of a scene, such as kN/m; "" for none. */
export function unit(words: string, units: Units | undefined): string {
  if (words === "-" || words === "") return "";
  const names: Record<string, string> = units
    ? { ...units, moment: `${units.force}·${units.length}`, angle: "rad" }
    : {};
  return words
    .replace(/;.*/, "") // what a sign means
    .replace(/[a-z]+/g, (word) => names[word] ?? word)
    .replace(/\^(\d)/g, (_, power: string) => POWERS[power] ?? `^${power}`)
    .replace(/ /g, "·");
}

/** A number with its unit. */
export const measured = (value: number, unit: string) => (unit ? `${said(value)} ${unit}` : said(value));

/** A field or kind of the catalogue as a heading: rest_factor is Rest factor. */
export const titled = (name: string) => (name.charAt(0).toUpperCase() + name.slice(1)).replaceAll("_", " ");

/** What a session is called: its label, or its key where somebody chose that. */
export const calledOf = ({ label, key }: { label: string; key: string }) =>
  label || (/^[0-9a-f]{32}$/.test(key) ? "Untitled model" : key);

/** Counted things. */
export const counted = (count: number, one: string) => `${count.toLocaleString("en")} ${one}${count === 1 ? "" : "s"}`;

const ID = "\\{?[0-9a-f]{8}-?(?:[0-9a-f]{4}-?){3}[0-9a-f]{12}\\}?";
const IDS = new RegExp(`,? ?\\(?(?:\\bids? )?${ID}(?:, ${ID})*\\)?`, "gi");

/** A sentence of the service without ids and pointers: /settings/time_step is the time step, /forces/0 force 0. */
export const plain = (sentence: string) =>
  sentence
    .replace(IDS, "")
    .replace(/^\/(?:family|rebuild): (.)/, (_, first: string) => first.toUpperCase())
    .replace(/^\/(?:rebuild\/)?([a-z]\w*): /, (_, field: string) => `${titled(field)}: `)
    .replace(/^\/(?:draw\/)?add\/(?:forces\/)?\d+(?:\/(\w+))?: (.)/, (_, field: string | undefined, first: string) =>
      field ? `${titled(field)}: ${first}` : first.toUpperCase(),
    )
    .replace(/\/meshes\/(?:layer:)?(.+?): /g, (_, name: string) => `Mesh ${name}: `)
    .replace(/\/settings\/(\w+)/g, (_, name: string) => `the ${name.replaceAll("_", " ")}`)
    .replace(/\/forces\/(\d+)(?:\/(\w+))?/g, (_, number: string, field?: string) =>
      field ? `${field.replaceAll("_", " ")} of force ${number}` : `force ${number}`,
    )
    .replace(/(^|\. )the ([a-z])/g, (_, before: string, first: string) => `${before}The ${first}`)
    .replace(/\b(?:the )?(time_step|weld_tolerance)\b/g, (_, name: string) => `the ${name.replace("_", " ")}`);

const NUMBERED = /\b(particle|spring)(?: (\d+)|s (\d+(?:(?:, and |, | and )\d+(?![\d.]))*))/g;

/** The particles a sentence speaks of, those at the ends of its springs included. */
export function particlesOf(sentence: string, springs: [number, number][]): number[] {
  const found = new Set<number>();
  for (const [, what, one, several] of sentence.matchAll(NUMBERED)) {
    for (const number of (one ?? several!).split(/\D+/).map(Number)) {
      const all = what === "particle" ? [number] : (springs[number] ?? []);
      all.forEach((particle) => found.add(particle));
    }
  }
  return [...found];
}
