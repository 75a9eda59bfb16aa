// What is seen, and from where; and along what a drag goes.
import type { Colouring, Layer, Lock, Look } from "../view/types";
import type { Studio } from "./studio";
import { said, titled } from "./words";

const COLOURINGS: [Colouring, string][] = [
  ["force", "Force"],
  ["strain", "Strain"],
  ["plain", "Plain"],
];

const LOCKS: [Lock, string][] = [
  ["view", "View plane"],
  ["x", "x axis"],
  ["y", "y axis"],
  ["z", "z axis"],
  ["xy", "xy plane"],
  ["xz", "xz plane"],
  ["yz", "yz plane"],
];

export const LOOKS: [Look, string][] = [
  ["perspective", "Perspective"],
  ["top", "Top"],
  ["front", "Front"],
  ["right", "Right"],
];

export function SeePanel({ studio: { options } }: { studio: Studio }) {
  const layers = options.layers.value;
  return (
    <>
      <fieldset class="choices">
        <legend>Colour springs by</legend>
        {COLOURINGS.map(([name, seen]) => (
          <label key={name}>
            <input
              type="radio"
              name="colouring"
              value={name}
              checked={options.colouring.value === name}
              onChange={() => (options.colouring.value = name)}
            />
            {seen}
          </label>
        ))}
      </fieldset>
      <fieldset class="choices layers">
        <legend>Layers</legend>
        {(Object.keys(layers) as Layer[]).map((layer) => (
          <label key={layer}>
            <input
              type="checkbox"
              checked={layers[layer]}
              onChange={(event) => (options.layers.value = { ...layers, [layer]: event.currentTarget.checked })}
            />
            {titled(layer)}
          </label>
        ))}
      </fieldset>
      <label class="field">
        <span>Drag along</span>
        <select
          value={options.lock.value}
          onChange={(event) => (options.lock.value = event.currentTarget.value as Lock)}
        >
          {LOCKS.map(([name, seen]) => (
            <option key={name} value={name}>
              {seen}
            </option>
          ))}
        </select>
      </label>
    </>
  );
}

/** Over the canvas: where from. */
export function Looks({ studio: { view } }: { studio: Studio }) {
  const now = view.value;
  return (
    <div class="looks" role="group" aria-label="View">
      <button
        type="button"
        disabled={!now}
        aria-keyshortcuts="f"
        title="All of it into view (f)"
        onClick={() => now?.fit()}
      >
        Fit
      </button>
      {LOOKS.map(([name, seen], i) => (
        <button
          key={name}
          type="button"
          disabled={!now}
          aria-keyshortcuts={String(i + 1)}
          title={`${seen} (${i + 1})`}
          onClick={() => now?.look(name)}
        >
          {seen}
        </button>
      ))}
    </div>
  );
}

/** Over the canvas: which number a colour stands for. */
export function LegendBox({ studio: { view, session } }: { studio: Studio }) {
  const legend = view.value?.legend.value;
  if (!legend) return null;
  const unit = legend.unit === "-" ? "" : ` ${legend.unit}`;
  const stale = session.connection.value !== "live";
  const middle =
    legend.low < 0 && legend.high > 0 && Math.abs(legend.low + legend.high) < 1e-9 * legend.high ? 0 : null;
  return (
    <figure class={stale ? "legend stale" : "legend"} aria-label={`Colours: ${legend.title}`}>
      <figcaption>
        {legend.title}
        {unit && ` [${unit.trim()}]`}
      </figcaption>
      <div class="ramp" style={{ background: `linear-gradient(to right, ${legend.colours.join(", ")})` }} />
      <div class="ends numbers">
        <span>{said(legend.low, 3)}</span>
        {middle !== null && <span>0</span>}
        <span>{said(legend.high, 3)}</span>
      </div>
    </figure>
  );
}
