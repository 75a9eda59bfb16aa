// Of what a goal is measured: the fields of its kind, filled in by what the scene has.
import type { Asked, Quantity } from "../quantities";
import type { Scene, Topology } from "../model";
import type { Options } from "../view/types";
import { kinds } from "./catalogue";
import { anchorsOf, nameOf } from "./designing";
import { titleOf } from "./forces";
import { numbered } from "./targets";
import { counted, titled } from "./words";

export interface Place {
  scene: Scene;
  topology: Topology;
  options: Options;
}

interface Shown {
  kind: Quantity;
  typed: Record<string, string>;
  place: Place;
  put: (typed: Record<string, string>) => void;
}

/** Fields that most goals need, before those that few do. */
export function Fields({ kind, typed, place, put }: Shown) {
  const often = kind.fields.filter(isOften);
  const seldom = kind.fields.filter((field) => !isOften(field));
  const field = (one: Asked) => (
    <FieldOf
      key={`${kind.kind} ${one.name}`}
      field={one}
      place={place}
      value={typed[one.name] ?? initial(one, place)}
      put={(text) => put({ ...typed, [one.name]: text })}
    />
  );
  return (
    <>
      {often.map(field)}
      {seldom.length > 0 && (
        <details class="seldom">
          <summary title="Values that may be left as they are">More fields</summary>
          {seldom.map(field)}
        </details>
      )}
    </>
  );
}

const isOften = ({ form, required }: Asked) => required || form === "choice";

interface OfField {
  field: Asked;
  place: Place;
  value: string;
  put: (text: string) => void;
}

function FieldOf({ field, place, value, put }: OfField) {
  const open = optionsOf(field, place);
  const label = titled(field.name);
  return (
    <label class="field" title={field.description}>
      <span>{label}</span>
      {open ? (
        <select aria-label={label} value={value} onChange={(event) => put(event.currentTarget.value)}>
          {open.map(([option, seen]) => (
            <option key={option} value={option}>
              {seen}
            </option>
          ))}
        </select>
      ) : (
        <input
          type="text"
          aria-label={label}
          placeholder={field.form === "particles" ? "0 3 5-8" : field.default === null ? "none" : String(field.default)}
          value={value}
          onInput={(event) => put(event.currentTarget.value)}
        />
      )}
    </label>
  );
}

/** What can be chosen, as what is sent and what is seen; null where a text is typed. */
function optionsOf({ form, choices, required }: Asked, { scene, topology }: Place): [string, string][] | null {
  const none: [string, string][] = required ? [] : [["", "none"]];
  if (form === "choice") return choices.map((choice) => [choice, [...choice].join(", ")]);
  if (form === "yes or no") return [["false", "no"], ["true", "yes"]];
  const by = (names: string[]) => [...none, ...names.map((name, i): [string, string] => [`${i}`, name])];
  if (form === "force") return by(scene.forces.map((force, i) => titleOf(force, kinds.value?.get(force.kind), i)));
  if (form === "anchor") return by(anchorsOf(scene).map(({ name }, i) => name || `Anchor ${i}`));
  if (form === "mesh") return [...none, ...Object.keys(topology.meshes).map((name): [string, string] => [name, name])];
  return null;
}

/** What a field has before somebody gives it a value. */
function initial(field: Asked, place: Place): string {
  if (field.form === "particles") return picked(place.options).join(" ");
  // the height is what is asked for most
  if (field.form === "choice" && field.choices.includes("z")) return "z";
  if (field.form === "yes or no") return String(field.default === true);
  return optionsOf(field, place)?.[0]?.[0] ?? "";
}

function picked({ picked: { value: one }, marked: { value: several } }: Options): number[] {
  return one?.kind === "particle" ? [one.index] : several;
}

export interface Given {
  fields: Record<string, unknown>;
  /** Of what it is measured, in words. */
  seen: string;
}

/** What was given, as the schema has it; a sentence where it is not. */
export function read(kind: Quantity, typed: Record<string, string>, place: Place): Given | string {
  const fields: Record<string, unknown> = {};
  for (const field of kind.fields) {
    const text = (typed[field.name] ?? initial(field, place)).trim();
    if (!text && !field.required) continue;
    const value = valueOf(field, text, place);
    if (typeof value === "object" && value && "fault" in value) return `${titled(field.name)}: ${value.fault}`;
    if (field.required || value !== field.default) fields[field.name] = value;
  }
  return { fields, seen: seenOf(fields, place) };
}

function valueOf({ form, name }: Asked, text: string, { scene }: Place): unknown {
  if (form === "force") return text ? nameOf(scene.forces, Number(text)) : { fault: "this scene has no forces." };
  if (form === "anchor") return text ? nameOf(anchorsOf(scene), Number(text)) : { fault: "this scene has no anchors." };
  if (form === "mesh") return text || { fault: "this scene has no mesh." };
  if (form === "yes or no") return text === "true";
  if (form === "choice" || form === "text") return text || { fault: "give a name." };
  if (form === "texts") return text.split(",").map((one) => one.trim());
  if (form === "particles" || name === "elements") {
    const found = numbered(text);
    if (typeof found === "string") return { fault: found };
    return found.length ? found : { fault: "give numbers, or pick a particle first." };
  }
  const rows = text.split(";").map((row) => row.split(/[\s,]+/).filter(Boolean).map(Number));
  if (rows.flat().some((number) => !Number.isFinite(number))) return { fault: `${text} given; give numbers.` };
  return form === "rows" ? rows : form === "numbers" ? rows[0] : rows[0]![0];
}

function seenOf(fields: Record<string, unknown>, { scene }: Place): string {
  const { particles, axes, force, anchor, mesh } = fields as Record<string, unknown> & { particles?: number[] };
  const parts: string[] = [];
  if (particles?.length === 1) parts.push(`particle ${particles[0]}`);
  else if (particles) parts.push(counted(particles.length, "particle"));
  if (force !== undefined) parts.push(typeof force === "number" ? `force ${force}` : String(force));
  if (anchor !== undefined) parts.push(typeof anchor === "number" ? `anchor ${anchor}` : String(anchor));
  if (mesh) parts.push(String(mesh));
  if (!parts.length) parts.push(scene.forces.length ? "the whole form" : "the form");
  return [...parts, ...(axes ? [String(axes)] : [])].join(", ");
}
