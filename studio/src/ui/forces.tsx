// The forces of the scene, with what may change of them while it runs.
import { useEffect } from "preact/hooks";
import type { Field, Kind, SceneForce, Units } from "../model";
import type { Session } from "../session";
import { amount, amounts, isValue, isVector, led, type Value } from "./amounts";
import { kinds, know } from "./catalogue";
import { NumberField } from "./number";
import { AddForce } from "./addforce";
import { AddLoad, RemoveForce } from "./loads";
import { Settings } from "./settings";
import { Slider } from "./slider";
import type { Studio } from "./studio";
import { counted, said, titled, unit } from "./words";

export function Forces({ studio }: { studio: Studio }) {
  const { session } = studio;
  const scene = session.scene.value;
  const live = session.connection.value === "live";
  useEffect(() => {
    // what cannot be read now is read again when the service is back
    if (live) know().catch(() => undefined);
  }, [live]);
  if (!scene && session.connection.value === "gone") return <p class="faint">The session was deleted.</p>;
  if (!scene || !kinds.value) return <p class="faint">Loading the scene ...</p>;
  return (
    <>
      {scene.forces.length === 0 && <p class="faint">This scene has no forces.</p>}
      {scene.forces.map((force, number) => (
        <Force key={`${number} ${force.kind}`} session={session} force={force} number={number} units={scene.units} />
      ))}
      <AddLoad session={session} />
      <AddForce studio={studio} />
      <Settings session={session} />
    </>
  );
}

/** Places and texts stay while it runs. */
const LED = ["number", "numbers", "vector", "vectors"];

interface Shown {
  session: Session;
  force: SceneForce;
  number: number;
  units: Units;
}

function Force({ session, force, number, units }: Shown) {
  const kind = kinds.value?.get(force.kind);
  const fields = kind?.fields.filter((field) => LED.includes(field.type)) ?? [];
  const [seldom, often] = [
    fields.filter((field) => isSeldom(field, force)),
    fields.filter((field) => !isSeldom(field, force)),
  ];
  const title = titleOf(force, kind, number);
  const column = (field: Field) => (
    <Column
      key={field.name}
      session={session}
      force={force}
      number={number}
      units={units}
      field={field}
      title={title}
    />
  );
  return (
    <fieldset class="force" data-force={force.name} tabIndex={-1}>
      <legend title={kind?.summary}>
        {title} {force.name && <span class="faint">{kind?.title}</span>}
      </legend>
      {often.map(column)}
      {seldom.length > 0 && (
        <details class="seldom">
          <summary title="Values that are not given, or are 0">More fields of {title}</summary>
          {seldom.map(column)}
        </details>
      )}
      {fields.length === 0 && <p class="faint">None of its values can change during a run.</p>}
      <RemoveForce session={session} number={number} title={title} />
    </fieldset>
  );
}

/** What a force is called: its name, or its kind with its number. */
export const titleOf = (force: SceneForce, kind: Kind | undefined, number: number) =>
  force.name || `${kind?.title ?? titled(force.kind)} ${number}`;

/** What does nothing as it is, such as a cutoff of 0, need not be seen at once. */
function isSeldom(field: Field, force: SceneForce): boolean {
  const value = force[field.name];
  return value === null || (field.default === 0 && value === 0);
}

function Column({ session, force, number, units, field, title }: Shown & { field: Field; title: string }) {
  const told = force[field.name];
  const measure = unit(field.unit, units);
  const name = `${title} ${field.name.replaceAll("_", " ")}`;
  const seen = titled(field.name);
  const change = (value: unknown) => ({ forces: { [String(number)]: { [field.name]: value } } });
  if (told === null) {
    return (
      <NumberField
        name={name}
        seen={seen}
        value={null}
        unit={measure}
        hint={field.description}
        placeholder="as drawn"
        bounds={field.bounds}
        disabled={session.connection.value !== "live"}
        done={(value) => value !== null && void session.tell(change(value))}
      />
    );
  }
  if (!isValue(told)) return null;
  const vectors = field.type.startsWith("vector");
  const live = session.connection.value === "live";
  if (field.components && isVector(told)) {
    // of such a vector no length has a meaning: it is led by its largest component
    const largest = amount(told, false);
    return (
      <>
        {field.components.map((part, at) => (
          <NumberField
            key={part}
            name={`${name} ${part}`}
            seen={`${seen} ${part}`}
            value={told[at]!}
            unit={measure}
            hint={field.description}
            disabled={!live}
            stale={!live}
            done={(to) => void session.tell(change(told.map((old, other) => (other === at ? (to ?? 0) : old))))}
          />
        ))}
        {largest !== 0 && (
          <Slider
            session={session}
            name={`Largest ${name}`}
            seen={`Largest ${seen.toLowerCase()}`}
            value={largest}
            unit={measure}
            hint={field.description}
            note="The others keep their ratios to it."
            bounds={undefined}
            log={false}
            patch={(to) => change(led(told, false, to))}
          />
        )}
      </>
    );
  }
  return (
    <>
      {isVector(told) && vectors && (
        <Components
          name={name}
          seen={seen}
          value={told}
          unit={measure}
          hint={field.description}
          session={session}
          change={change}
        />
      )}
      {(!vectors || measure !== "") && (
        <Slider
          session={session}
          name={!vectors ? name : field.name === "vector" ? `Size of ${title}` : `${name} size`}
          seen={!vectors ? seen : field.name === "vector" ? "Size" : `${seen} size`}
          value={amount(told, vectors)}
          unit={measure}
          hint={field.description}
          note={noteOf(told, vectors)}
          bounds={vectors ? { minimum: 0 } : field.bounds}
          log={/stiffness|strength/.test(field.name)}
          patch={(to) => change(led(told, vectors, to))}
        />
      )}
    </>
  );
}

/** Of how many the amount is the largest; "" where there is one. */
function noteOf(value: Value, vectors: boolean): string {
  const all = amounts(value, vectors);
  if (all.length === 1 || (vectors && isVector(value))) return "";
  const least = all.reduce((a, b) => Math.min(a, b));
  const most = all.reduce((a, b) => Math.max(a, b));
  const spread = least === most ? "all the same" : `from ${said(least)} to ${said(most)}`;
  return `${counted(all.length, "element")}, ${spread}; changes keep their ratios.`;
}

interface OfVector {
  session: Session;
  name: string;
  seen: string;
  value: [number, number, number];
  unit: string;
  hint: string;
  change: (value: number[]) => { forces: Record<string, Record<string, unknown>> };
}

function Components({ session, name, seen, value, unit: measure, hint, change }: OfVector) {
  const live = session.connection.value === "live";
  return (
    <div class="components" role="group" aria-label={name}>
      <span class="seen">{seen}</span>
      {value.map((component, axis) => (
        <NumberField
          key={axis}
          name={`${name} ${"xyz"[axis]}`}
          seen={"xyz"[axis]!}
          value={component}
          unit=""
          hint={hint}
          disabled={!live}
          stale={!live}
          done={(to) => void session.tell(change(value.map((old, other) => (other === axis ? (to ?? 0) : old))))}
        />
      ))}
      <span class="unit">{measure}</span>
    </div>
  );
}
