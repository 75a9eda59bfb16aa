// The section: a plane beyond which nothing of the form is shown.
import type { Section } from "../view/types";
import { NumberField } from "./number";
import type { Studio } from "./studio";

const AXES: [string, string][] = [
  ["", "None"],
  ["x", "Across x"],
  ["y", "Across y"],
  ["z", "Across z"],
];
const STEPS = 200;

export function SectionChoice({ studio: { options, session, view } }: { studio: Studio }) {
  const section = options.section.value;
  const unit = session.topology.value?.units.length ?? "";
  const [low, high] = extent(view.value?.particles() ?? new Float32Array(), section?.axis ?? "z");
  const put = (change: Partial<Section>) => section && (options.section.value = { ...section, ...change });
  const choose = (axis: string) => {
    const [from, to] = extent(view.value?.particles() ?? new Float32Array(), axis);
    const middle = Number(((from + to) / 2).toPrecision(4));
    const isTurned = section?.isTurned ?? false;
    options.section.value = axis ? { axis: axis as Section["axis"], at: middle, isTurned } : null;
  };
  return (
    <div class="section">
      <label class="field" title="Cuts the picture by a plane, to look inside; the model stays as it is">
        <span>Section plane</span>
        <select
          aria-label="Section plane"
          value={section?.axis ?? ""}
          onChange={(event) => choose(event.currentTarget.value)}
        >
          {AXES.map(([axis, seen]) => (
            <option key={axis} value={axis}>
              {seen}
            </option>
          ))}
        </select>
      </label>
      {section && (
        <>
          <input
            type="range"
            aria-label={`Section at ${section.axis} [${unit}]`}
            title="Where the plane crosses this axis"
            min={low}
            max={high}
            step={(high - low) / STEPS || 1}
            value={section.at}
            onInput={(event) => put({ at: Number(event.currentTarget.value) })}
          />
          <NumberField
            name={`Section at ${section.axis}, typed`}
            seen={`At ${section.axis}`}
            unit={unit}
            hint="Where the plane crosses this axis"
            value={section.at}
            done={(at) => at !== null && put({ at })}
          />
          <label class="check" title="Shows what the plane has cut away, and hides the rest">
            <input
              type="checkbox"
              checked={section.isTurned}
              onChange={(event) => put({ isTurned: event.currentTarget.checked })}
            />
            Show the other side
          </label>
        </>
      )}
    </div>
  );
}

/** The least and the largest coordinate along an axis. */
function extent(positions: Float32Array, axis: string): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (let i = "xyz".indexOf(axis || "z"); i < positions.length; i += 3) {
    low = Math.min(low, positions[i]!);
    high = Math.max(high, positions[i]!);
  }
  return low < high ? [low, high] : [Number.isFinite(low) ? low - 1 : -1, Number.isFinite(high) ? high + 1 : 1];
}
