// A number that is typed: what is shown is of now until somebody writes, and is sent when it is done.
import { useSignal } from "@preact/signals";
import { useId } from "preact/hooks";
import type { Bounds } from "../model";
import { said } from "./words";

interface Told {
  /** Its name; `seen` is what stands before it, where that is shorter. */
  name: string;
  seen?: string;
  value: number | null;
  unit: string;
  hint?: string;
  placeholder?: string;
  bounds?: Bounds | undefined;
  whole?: boolean;
  disabled?: boolean;
  stale?: boolean;
  /** Null: it was emptied. */
  done: (value: number | null) => void;
}

export function NumberField({
  name,
  seen,
  value,
  unit,
  hint,
  placeholder,
  bounds,
  whole,
  disabled,
  stale,
  done,
}: Told) {
  const typed = useSignal<string | null>(null);
  const fault = useSignal("");
  const id = useId();
  const commit = (text: string) => {
    typed.value = null;
    const wrong = fit(text, bounds, whole === true, placeholder !== undefined);
    fault.value = wrong && `${name}: ${wrong}`;
    if (!wrong) done(text.trim() === "" ? null : Number(text));
  };
  return (
    <span class="field">
      {seen && <label for={id}>{seen}</label>}
      <input
        id={id}
        type="number"
        step={whole ? 1 : "any"}
        class={stale ? "number stale" : "number"}
        aria-label={unit ? `${name} [${unit}]` : name}
        aria-invalid={fault.value !== ""}
        title={hint}
        placeholder={placeholder}
        disabled={disabled}
        value={typed.value ?? (value === null ? "" : said(value, 6))}
        onInput={(event) => (typed.value = event.currentTarget.value)}
        onChange={(event) => commit(event.currentTarget.value)}
        onBlur={() => (typed.value = null)}
        onKeyDown={(event) => {
          if (event.key !== "Escape") return;
          typed.value = null;
          fault.value = "";
        }}
      />
      {unit && (
        <span class="unit" aria-hidden="true">
          {unit}
        </span>
      )}
      {fault.value && (
        <span class="fault" role="alert">
          {fault.value}
        </span>
      )}
    </span>
  );
}

/** The fault of a typed text, in a sentence; "" for none. */
function fit(text: string, bounds: Bounds | undefined, whole: boolean, emptied: boolean): string {
  const value = Number(text);
  if (text.trim() === "") return emptied ? "" : "give a number.";
  if (!Number.isFinite(value)) return `${text} is not a number.`;
  if (whole && !Number.isInteger(value)) return `${text} given; give a whole number.`;
  const { minimum, maximum, more_than, less_than } = bounds ?? {};
  if (minimum !== undefined && value < minimum) return `${text} given; at least ${minimum} allowed.`;
  if (maximum !== undefined && value > maximum) return `${text} given; at most ${maximum} allowed.`;
  if (more_than !== undefined && value <= more_than) return `${text} given; more than ${more_than} allowed.`;
  if (less_than !== undefined && value >= less_than) return `${text} given; less than ${less_than} allowed.`;
  return "";
}
