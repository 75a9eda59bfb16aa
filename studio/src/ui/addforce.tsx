// A force of any kind, put on a place of a running session by its schema: an edit, which can be undone.
import { useSignal } from "@preact/signals";
import type { Field, Kind, SceneForce } from "../model";
import { kinds } from "./catalogue";
import { choose, freeName, useEdit } from "./loads";
import { present } from "../view/faces";
import { type Where, onFaces, placed, places } from "./targets";
import type { Studio } from "./studio";
import { usual } from "./usual";
import { titled, unit } from "./words";

const ROLES: [string, string][] = [
  ["load", "Loads"],
  ["internal", "Between particles"],
  ["support", "Supports and guides"],
];
/** Fields that say where a force acts. */
export const PLACES = ["particles", "points", "lines", "mesh", "name"];

export function AddForce({ studio }: { studio: Studio }) {
  const { session, options } = studio;
  const topology = session.topology.value;
  const scene = session.scene.value;
  const name = useSignal("unary");
  const chosen = useSignal<Where | "">("");
  const numbers = useSignal("");
  const typed = useSignal<Record<string, string>>({});
  const fault = useSignal("");
  const { busy, make } = useEdit(session);
  const kind = kinds.value?.get(name.value);
  if (!topology || !scene || !kind) return null;
  const faces = present(topology, options.markedFaces.value);
  const open = places(kind, topology, faces);
  const where = open.some(([place]) => place === chosen.value) ? (chosen.value as Where) : open[0]?.[0];
  const fields = kind.fields.filter((field) => !PLACES.includes(field.name));
  const add = async (event: Event) => {
    event.preventDefault();
    const at = where && where !== "faces" ? placed(where, kind, { session, options, numbers: numbers.value }) : {};
    const values = typeof at === "string" ? at : valuesOf(fields, typed.value);
    fault.value = typeof values === "string" ? values : "";
    if (typeof at === "string" || typeof values === "string") return;
    const force = { kind: kind.kind, name: freeName(scene, kind.title.toLowerCase()), ...at, ...values } as SceneForce;
    const edit = where === "faces" ? onFaces(topology, faces, force) : { add: [force] };
    if (await make(edit, `${kind.title} was added; Undo takes it back.`)) {
      typed.value = usual(kind.kind, topology.units);
      options.marked.value = ((at["particles"] ?? []) as number[] | number[][]).flat();
      choose(force.name);
    }
  };
  return (
    <details class="seldom">
      <summary title="Loads, springs, pressure, contact and all others, with their values">
        Add a force of any kind
      </summary>
      <form class="addforce" onSubmit={(event) => void add(event)}>
        <label class="field">
          <span>Kind</span>
          <select
            aria-label="Kind"
            value={kind.kind}
            title={kind.summary}
            onChange={(event) => {
              name.value = event.currentTarget.value;
              [typed.value, fault.value] = [usual(name.value, topology.units), ""];
            }}
          >
            {ROLES.map(([role, seen]) => (
              <optgroup key={role} label={seen}>
                {[...kinds.value!.values()]
                  .filter((other) => other.role === role)
                  .map((other) => (
                    <option key={other.kind} value={other.kind}>
                      {other.title}
                    </option>
                  ))}
              </optgroup>
            ))}
          </select>
        </label>
        <p class="note">{kind.summary}</p>
        {open.length > 0 && (
          <label class="field" title="Where the force acts: all particles, what is picked or selected, springs, a mesh">
            <span>On</span>
            <select
              aria-label="On"
              value={where}
              onChange={(event) => (chosen.value = event.currentTarget.value as Where)}
            >
              {open.map(([place, seen]) => (
                <option key={place} value={place}>
                  {seen}
                </option>
              ))}
            </select>
          </label>
        )}
        {open.length === 0 && isOnMesh(kind) && <p class="note">This scene has no mesh, which this kind needs.</p>}
        {where === "numbers" && (
          <label class="field">
            <span>Numbers</span>
            <input
              type="text"
              aria-label="Numbers"
              placeholder="0 3 5-8"
              value={numbers.value}
              onInput={(event) => (numbers.value = event.currentTarget.value)}
            />
          </label>
        )}
        {fields.map((field) => (
          <label key={`${kind.kind} ${field.name}`} class="field" title={field.description}>
            <span>{titled(field.name)}</span>
            <Input
              field={field.name === "target" ? { ...field, choices: Object.keys(scene["meshes"] ?? {}) } : field}
              value={typed.value[field.name] ?? ""}
              put={(text) => (typed.value = { ...typed.value, [field.name]: text })}
            />
            <span class="unit">{unit(field.unit, scene.units)}</span>
          </label>
        ))}
        {fault.value && (
          <p class="fault" role="alert">
            {fault.value}
          </p>
        )}
        <button
          type="submit"
          disabled={busy || session.connection.value !== "live"}
          title="Add this force to the model at the place and with the values above; Undo removes it"
        >
          Add {kind.title.toLowerCase()}
        </button>
      </form>
    </details>
  );
}

interface Typed {
  field: Field;
  value: string;
  put: (text: string) => void;
}

/** A field of a force, typed as text or chosen. */
export function Input({ field, value, put }: Typed) {
  const choices = field.choices ?? (field.type === "yes or no" ? ["true", "false"] : null);
  if (choices)
    return (
      <select aria-label={titled(field.name)} value={value} onChange={(event) => put(event.currentTarget.value)}>
        {["", ...choices].map((choice) => (
          <option key={choice} value={choice}>
            {choice || `default: ${String(field.default ?? "") || "none"}`}
          </option>
        ))}
      </select>
    );
  return (
    <input
      type="text"
      aria-label={titled(field.name)}
      value={value}
      required={field.required === true}
      placeholder={field.default == null ? (field.required ? "needed" : "none") : String(field.default)}
      onInput={(event) => put(event.currentTarget.value)}
    />
  );
}

/** What was typed, as the schema has it; a sentence where it is not. */
export function valuesOf(fields: Field[], typed: Record<string, string>): Record<string, unknown> | string {
  const found: Record<string, unknown> = {};
  for (const field of fields) {
    const text = (typed[field.name] ?? "").trim();
    if (!text) continue;
    if (field.type === "text" || field.choices) found[field.name] = text;
    else if (field.type === "yes or no") found[field.name] = text === "true";
    else {
      const isNet = /^(rows of points|lines)$/.test(field.type);
      const rows = text.split(";").map((row) => (isNet ? row.split(",").map(numbersOf) : numbersOf(row)));
      const isWrong = rows.flat(2).some((value) => !Number.isFinite(value));
      if (isWrong) return `${titled(field.name)}: ${text} given; ${isNet ? OF_POINTS : OF_NUMBERS}`;
      const whole = rows.length > 1 || /points|lines/.test(field.type) ? rows : rows[0]!;
      const isOne = whole.length === 1 && typeof whole[0] === "number" && field.type !== "indices";
      found[field.name] = isOne ? whole[0] : whole;
    }
  }
  return found;
}

const numbersOf = (text: string) => text.split(/[\s,]+/).filter(Boolean).map(Number);

const OF_NUMBERS = "give numbers, with ; between rows.";
const OF_POINTS = "give x y z of each point, with , between points and ; between rows.";

/** Whether it acts on meshes alone. */
const isOnMesh = ({ fields }: Kind) => has(fields, "mesh") && !has(fields, "particles");

const has = (fields: Field[], name: string) => fields.some((field) => field.name === name);
