// A new model from nothing: a shape by its parameters, in units that are chosen at the start.
import { useSignal } from "@preact/signals";
import * as api from "../api";
import { BEGINNINGS, sceneOf } from "./newscenes";
import { refuse } from "./notices";
import { NumberField } from "./number";
import { go, met } from "./place";
import { unit } from "./words";

const LENGTHS = ["m", "cm", "mm", "ft", "in"];
const FORCES = ["N", "kN"];

export function New() {
  const chosen = useSignal(0);
  const typed = useSignal<Record<string, number>>({});
  const units = useSignal({ length: "m", force: "kN", time: "s" });
  const stiffness = useSignal(100);
  const factor = useSignal(1);
  const busy = useSignal(false);
  const beginning = BEGINNINGS[chosen.value]!;
  const values = Object.fromEntries(beginning.parameters.map((one) => [one.name, typed.value[one.name] ?? one.value]));
  const make = async (event: Event) => {
    event.preventDefault();
    busy.value = true;
    try {
      const scene = sceneOf(beginning.make(values), units.value, stiffness.value, factor.value);
      go((await api.create(scene, beginning.name)).key);
    } catch (error) {
      met(error);
      refuse(error, "The model was not made. ");
    } finally {
      busy.value = false;
    }
  };
  const pick = (which: "length" | "force", all: string[]) => (
    <label class="field">
      <span>Unit of {which}</span>
      <select
        aria-label={`Unit of ${which}`}
        value={units.value[which]}
        onChange={(event) => (units.value = { ...units.value, [which]: event.currentTarget.value })}
      >
        {all.map((one) => (
          <option key={one}>{one}</option>
        ))}
      </select>
    </label>
  );
  return (
    <details class="seldom">
      <summary>New model</summary>
      <form class="addforce" onSubmit={(event) => void make(event)}>
        <label class="field">
          <span>Shape</span>
          <select
            aria-label="Shape"
            value={chosen.value}
            title={beginning.hint}
            onChange={(event) => (chosen.value = Number(event.currentTarget.value))}
          >
            {BEGINNINGS.map(({ name }, number) => (
              <option key={name} value={number}>
                {name}
              </option>
            ))}
          </select>
        </label>
        <p class="note">{beginning.hint}.</p>
        {pick("length", LENGTHS)}
        {pick("force", FORCES)}
        {beginning.parameters.map((one) => (
          <NumberField
            key={`${beginning.name} ${one.name}`}
            name={one.seen}
            seen={one.seen}
            value={values[one.name]!}
            unit={unit(one.unit, units.value)}
            bounds={{ minimum: one.minimum, maximum: one.maximum }}
            whole={one.whole === true}
            done={(value) => value !== null && (typed.value = { ...typed.value, [one.name]: value })}
          />
        ))}
        <NumberField
          name="Stiffness"
          seen="Stiffness"
          hint="Force that stretches a spring by one unit of length"
          value={stiffness.value}
          unit={unit("force/length", units.value)}
          bounds={{ more_than: 0 }}
          done={(value) => value !== null && (stiffness.value = value)}
        />
        <NumberField
          name="Rest factor"
          seen="Rest factor"
          hint="Rest length as a part of the drawn length: below 1 the net is stretched, 0 gives a minimal net"
          value={factor.value}
          unit=""
          bounds={{ minimum: 0 }}
          done={(value) => value !== null && (factor.value = value)}
        />
        <button type="submit" disabled={busy.value}>
          Make the {beginning.name.toLowerCase()}
        </button>
      </form>
    </details>
  );
}
