// Colours, layers, views and the axis lock of drags.
import { useEffect, useState } from "preact/hooks";
import { lookOf } from "../view/camera";
import { palette } from "../view/colours";
import type { Colouring, Layer, Legend, Lock, Look } from "../view/types";
import { ScaleChoice } from "./scalechoice";
import type { Studio } from "./studio";
import { dark } from "./theme";
import { counted, measured, said, titled } from "./words";

const COLOURINGS: [Colouring, string][] = [
  ["force", "Force"],
  ["strain", "Strain"],
  ["plain", "Plain"],
];

const HINTS: Record<Colouring, string> = {
  force: "Force in each spring: tension is above 0, compression below",
  strain: "Change of length over rest length, 0 at rest; 0.01 is 1 %",
  plain: "One colour",
  given: "Numbers that a program gave",
};

const LAYERS: Record<Layer, string> = {
  mesh: "Faces",
  springs: "Springs and other lines on which forces act",
  particles: "Particles that are not held",
  anchors: "Particles that are held, as squares",
  loads: "Arrows of the forces on particles, in proportion to the longest",
  reactions: "Arrows of the forces that hold particles, in proportion to the longest",
  floor: "The plane on which particles come to rest",
  guides: "Curves and surfaces that forces pull to",
};

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

export function SeePanel({ studio: { options, session } }: { studio: Studio }) {
  const layers = options.layers.value;
  const given = options.given.value;
  const colourings: [Colouring, string][] = given ? [...COLOURINGS, ["given", given.title]] : COLOURINGS;
  return (
    <>
      <fieldset class="choices">
        <legend>Colour springs by</legend>
        {colourings.map(([name, seen]) => (
          <label key={name} title={HINTS[name]}>
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
      {options.colouring.value !== "plain" && <ScaleChoice studio={{ options, session }} />}
      <fieldset class="choices layers">
        <legend>Layers</legend>
        {(Object.keys(layers) as Layer[]).map((layer) => (
          <label key={layer} title={LAYERS[layer]}>
            <input
              type="checkbox"
              checked={layers[layer]}
              onChange={(event) => (options.layers.value = { ...layers, [layer]: event.currentTarget.checked })}
            />
            {titled(layer)}
          </label>
        ))}
      </fieldset>
      {!session.readOnly && (
        <label class="field" title="Along what a dragged particle moves; view plane: as the pointer">
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
      )}
    </>
  );
}

/** Over the canvas: the views, the one that is on pressed; once it is turned by hand, none is. */
export function Looks({ studio: { view } }: { studio: Studio }) {
  const now = view.value;
  const [look, setLook] = useState<Look | null>(null);
  useEffect(() => {
    if (!now) return;
    const read = () => setLook(lookOf(now.place()));
    read();
    return now.onMoved(read);
  }, [now]);
  return (
    <div class="looks" role="group" aria-label="View">
      <button
        type="button"
        disabled={!now}
        aria-keyshortcuts="f"
        title="Zoom to fit (F)"
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
          aria-pressed={look === name}
          title={`${seen} (${i + 1})`}
          onClick={() => now?.look(name)}
        >
          {seen}
        </button>
      ))}
    </div>
  );
}

/** Over the canvas: the values of colours and of the longest arrows. */
export function LegendBox({ studio: { view, session, options } }: { studio: Studio }) {
  const legend = view.value?.legend.value;
  const { load, reaction } = view.value?.arrows.value ?? { load: 0, reaction: 0 };
  const { loads, reactions } = options.layers.value;
  const force = session.topology.value?.units.force ?? "";
  const colours = palette(dark.value);
  const stale = session.connection.value !== "live";
  const variant = options.ghost.value;
  const faces = view.value?.faces.value;
  const { colouring, restLengths } = options;
  const isUndefined = colouring.value === "strain" && restLengths.value?.every((rest) => rest === 0);
  if (!legend && !faces && !load && !reaction && !variant && !isUndefined) return null;
  return (
    <div class={stale ? "legend stale" : "legend"} role="group" aria-label="Legend">
      {variant && <Overlaid name={variant.name} own={legend?.colours ?? [colours.plain]} colour={colours.variant} />}
      {isUndefined && <p>Strain: undefined, the rest lengths are 0</p>}
      {legend && <Ramp legend={legend} mark={() => (options.marked.value = view.value?.beyond() ?? [])} />}
      {faces && <Ramp legend={faces} mark={() => (options.marked.value = view.value?.facesBeyond() ?? [])} />}
      {loads && load > 0 && <Arrow name="Load" size={load} unit={force} colour={colours.load} />}
      {reactions && reaction > 0 && <Arrow name="Reaction" size={reaction} unit={force} colour={colours.reaction} />}
    </div>
  );
}

interface OfRamp {
  legend: Legend;
  mark: () => void;
}

function Ramp({ legend: { title, unit, low, high, beyond, equal, colours }, mark }: OfRamp) {
  if (equal !== null)
    return (
      <p>
        {title}: all equal, <span class="numbers">{measured(equal, unit === "-" ? "" : unit)}</span>
      </p>
    );
  const isEven = low < 0 && Math.abs(low + high) < 1e-9 * high;
  return (
    <div>
      <p>
        {title} {unit && unit !== "-" ? `[${unit}]` : ""}
      </p>
      <div class="ramp" style={{ background: `linear-gradient(to right, ${colours.join(", ")})` }} />
      <p class="ends numbers">
        <span>{said(low, 3)}</span>
        {isEven && <span>0</span>}
        <span>{said(high, 3)}</span>
      </p>
      {beyond > 0 && (
        <button type="button" class="small" title="Mark what has values beyond the scale" onClick={mark}>
          {counted(beyond, "value")} beyond
        </button>
      )}
    </div>
  );
}

/** Which colours are the model's, and which a variant's over it. */
function Overlaid({ name, own, colour }: { name: string; own: string[]; colour: string }) {
  const both: [string, string][] = [
    ["This model", own.length > 1 ? `linear-gradient(to right, ${own.join(", ")})` : own[0]!],
    [name, colour],
  ];
  return (
    <div class="overlaid">
      {both.map(([seen, background]) => (
        <p key={seen} class="arrow" title={seen}>
          <span class="stroke" style={{ background }} aria-hidden="true" />
          <span class="name">{seen}</span>
        </p>
      ))}
    </div>
  );
}

interface OfArrow {
  name: string;
  size: number;
  unit: string;
  colour: string;
}

const Arrow = ({ name, size, unit, colour }: OfArrow) => (
  <p class="arrow" title="The longest arrow">
    <svg viewBox="0 0 28 10" width="28" height="10" aria-hidden="true" stroke={colour} fill={colour}>
      <path d="M0 5h20" stroke-width="2" />
      <path d="M19 1v8l8-4z" stroke="none" />
    </svg>
    {name} <span class="numbers">up to {measured(Number(size.toPrecision(3)), unit)}</span>
  </p>
);
