// What drawn lines and faces become: a kind of the catalogue with the values of its schema.
import type { Signal } from "@preact/signals";
import type { Kind, SceneForce, Units } from "../model";
import { Input, PLACES, valuesOf } from "../ui/addforce";
import { kinds } from "../ui/catalogue";
import { usual } from "../ui/usual";
import { titled, unit } from "../ui/words";

/** A kind by its name, or "" for nothing, with what was typed into its fields. */
export interface Chosen {
  kind: string;
  name: string;
  typed: Record<string, string>;
}

export type Of = "lines" | "faces";

const has = (kind: Kind, field: string) => kind.fields.some(({ name }) => name === field);

/** The kinds that lines between two particles, or faces of a mesh, may become. */
export function kindsOf(of: Of): Kind[] {
  return [...(kinds.value?.values() ?? [])].filter((kind) =>
    of === "lines"
      ? kind.particles_per_element === 2 && has(kind, "particles") && kind.role === "internal"
      : has(kind, "mesh") && (kind.role === "internal" || kind.kind === "pressure"),
  );
}

/** The force, without its place; a sentence where a field is wrong; null for nothing. */
export function forceOf(of: Of, chosen: Chosen): SceneForce | string | null {
  const kind = kinds.value?.get(chosen.kind);
  if (!kind) return null;
  const values = valuesOf(fieldsOf(kind), chosen.typed);
  if (typeof values === "string") return values;
  const name = chosen.name.trim() || `drawn ${of}`;
  return { kind: kind.kind, name, ...(of === "faces" ? { mesh: name } : {}), ...values } as SceneForce;
}

const fieldsOf = (kind: Kind) => kind.fields.filter(({ name }) => ![...PLACES, "edges"].includes(name));

interface Told {
  of: Of;
  chosen: Signal<Chosen>;
  units: Units;
}

/** The kind, its name, and below a disclosure its fields. */
export function Become({ of, chosen, units }: Told) {
  const { kind: name, typed } = chosen.value;
  const kind = kinds.value?.get(name);
  const what = of === "lines" ? "Lines" : "Faces";
  return (
    <div role="group" aria-label={`Drawn ${of}`} class="become">
      <label class="field" title={kind?.summary ?? "Particles alone, without a force; forces can be added later"}>
        <span>{what} become</span>
        <select
          aria-label={`${what} become`}
          value={name}
          onChange={(event) => {
            const to = event.currentTarget.value;
            chosen.value = { kind: to, name: chosen.value.name, typed: usual(to, units) };
          }}
        >
          <option value="">{of === "lines" ? "Nothing" : "A mesh alone"}</option>
          {kindsOf(of).map((other) => (
            <option key={other.kind} value={other.kind}>
              {other.title}
            </option>
          ))}
        </select>
      </label>
      <label class="field wide" title="What is drawn under one name and with the same values is one force">
        <span>Name</span>
        <input
          type="text"
          aria-label={`Name of ${of}`}
          placeholder={`drawn ${of}`}
          value={chosen.value.name}
          onInput={(event) => (chosen.value = { ...chosen.value, name: event.currentTarget.value })}
        />
      </label>
      {kind && (
        <details class="seldom">
          <summary title="Of what is drawn next; defaults are in grey">Values of {kind.title.toLowerCase()}</summary>
          {fieldsOf(kind).map((field) => (
            <label key={`${kind.kind} ${field.name}`} class="field" title={field.description}>
              <span>{titled(field.name)}</span>
              <Input
                field={field}
                value={typed[field.name] ?? ""}
                put={(text) => (chosen.value = { ...chosen.value, typed: { ...typed, [field.name]: text } })}
              />
              <span class="unit">{unit(field.unit, units)}</span>
            </label>
          ))}
        </details>
      )}
    </div>
  );
}
