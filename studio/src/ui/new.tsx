// A new model from nothing: a family by its parameters, in units that are chosen at the start.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import * as api from "../api";
import type { Field, Parameters } from "../model";
import { Choice } from "./choice";
import { families, knowFamilies, seenOf } from "./families";
import { refuse } from "./notices";
import { NumberField } from "./number";
import { go, met } from "./place";
import { inUnits } from "./usual";

export const LENGTHS = ["m", "cm", "mm", "ft", "in"];
export const FORCES = ["N", "kN"];

const EMPTY = "An empty page: draw points, lines and faces by clicks, and choose what they become.";

export function New() {
  const chosen = useSignal("saddle");
  const typed = useSignal<Parameters>({});
  const units = useSignal({ length: "m", force: "kN", time: "s" });
  const busy = useSignal(false);
  useEffect(() => {
    knowFamilies().catch(met);
  }, []);
  if (!families.value) return null;
  const family = families.value.find(({ name }) => name === chosen.value);
  const summary = family?.summary ?? EMPTY;
  // the same size in every unit
  const valueOf = ({ name, default: usually, unit }: Field) =>
    typed.value[name] ?? (typeof usually === "number" ? inUnits(usually, unit, units.value) : String(usually));
  const make = async (event: Event) => {
    event.preventDefault();
    busy.value = true;
    const values = Object.fromEntries((family?.parameters ?? []).map((field) => [field.name, valueOf(field)]));
    try {
      const scene = family ? await api.familyScene(family.name, units.value, values) : { units: units.value };
      go((await api.create(scene, family?.title ?? "Drawing")).key);
    } catch (error) {
      met(error);
      refuse(error, "The model was not made. ");
    } finally {
      busy.value = false;
    }
  };
  const take = (name: string, value: number | string) => (typed.value = { ...typed.value, [name]: value });
  return (
    <details class="seldom">
      <summary title="A cable, net, dome, vault or other shape from its measures, or an empty page to draw on">
        New model
      </summary>
      <form class="addforce" onSubmit={(event) => void make(event)}>
        <label class="field">
          <span>Shape</span>
          <select
            aria-label="Shape"
            value={chosen.value}
            title={summary}
            onChange={(event) => ([chosen.value, typed.value] = [event.currentTarget.value, {}])}
          >
            <option value="">Empty page</option>
            {families.value.map(({ name, title }) => (
              <option key={name} value={name}>
                {title}
              </option>
            ))}
          </select>
        </label>
        <p class="note">{summary}</p>
        {(["length", "force"] as const).map((which) => (
          <Choice
            key={which}
            name={`Unit of ${which}`}
            hint="Of all numbers of the model; it can be another for each model"
            value={units.value[which]}
            choices={which === "length" ? LENGTHS : FORCES}
            done={(value) => (units.value = { ...units.value, [which]: value })}
          />
        ))}
        {family?.parameters.map((field) => {
          const { seen, ...told } = seenOf(field, units.value);
          const value = valueOf(field);
          const key = `${family.name} ${field.name}`;
          const done = (to: number | string | null) => to !== null && take(field.name, to);
          if (typeof value === "string")
            return (
              <Choice key={key} name={seen} value={value} choices={field.choices ?? []} hint={told.hint} done={done} />
            );
          return (
            <NumberField key={key} name={seen} seen={seen} {...told} value={value} bounds={field.bounds} done={done} />
          );
        })}
        <button
          type="submit"
          disabled={busy.value}
          title="A new session with this model; its measures can be changed later"
        >
          Make the {family?.title.toLowerCase() ?? "empty page"}
        </button>
      </form>
    </details>
  );
}
