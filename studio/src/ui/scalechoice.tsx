// How numbers become colours: the kind of scale, and its ends where they are typed.
import type { Scale, ScaleKind } from "../view/types";
import { NumberField } from "./number";
import type { Studio } from "./studio";

const KINDS: [ScaleKind, string, string][] = [
  ["auto", "Automatic", "From the smallest to the largest value but outliers, about 0 where both signs occur"],
  ["even", "Symmetric about 0", "As far below 0 as above: tension and compression compare by colour"],
  ["log", "Logarithmic", "By the power of ten of the size: small values differ in colour, too"],
];

export function ScaleChoice({ studio: { options, session } }: { studio: Pick<Studio, "options" | "session"> }) {
  const scale = options.scale.value;
  const unit = options.colouring.value === "force" ? (session.topology.value?.units.force ?? "") : "";
  const change = (part: Partial<Scale>) => (options.scale.value = { ...scale, ...part });
  const end = (which: "low" | "high", seen: string) => (
    <NumberField
      name={`${seen} of the colours`}
      seen={seen}
      value={scale[which]}
      unit={unit}
      hint="Values beyond have the colour of the end and are counted in the legend; empty: automatic"
      placeholder="automatic"
      bounds={scale.kind === "log" ? { more_than: 0 } : undefined}
      done={(value) => change({ [which]: value })}
    />
  );
  return (
    <>
      <label class="field">
        <span>Scale</span>
        <select
          aria-label="Scale of the colours"
          title={KINDS.find(([kind]) => kind === scale.kind)?.[2]}
          value={scale.kind}
          onChange={(event) => change({ kind: event.currentTarget.value as ScaleKind, low: null, high: null })}
        >
          {KINDS.map(([kind, seen]) => (
            <option key={kind} value={kind}>
              {seen}
            </option>
          ))}
        </select>
      </label>
      {end("low", "From")}
      {end("high", "To")}
    </>
  );
}
