// Distances and angles between particles, and their numbers, on the canvas and in the panel.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Point } from "../model";
import { shownFrame } from "./still";
import type { Studio } from "./studio";
import { numbered } from "./targets";
import { measured, said } from "./words";

/** More numbers than these are not read. */
const MOST = 300;

export function Measure({ studio }: { studio: Studio }) {
  const { session, options } = studio;
  void session.ticks.value;
  const text = useSignal("");
  const fault = useSignal("");
  const [frame, topology] = [shownFrame(studio), session.topology.value];
  const chain = options.measured.value;
  const measure = (given: string) => {
    text.value = given;
    const found = numbered(given);
    const beyond = typeof found === "string" ? undefined : found.find((one) => one >= (topology?.particles ?? 0));
    fault.value =
      typeof found === "string" ? found : beyond === undefined ? "" : `There is no particle ${beyond} in this model.`;
    options.measured.value = fault.value || typeof found === "string" ? [] : found;
  };
  const unit = topology?.units.length ?? "";
  const places = frame ? chain.map((particle) => at(frame.positions, particle)) : [];
  const between = () => {
    const { picked, marked } = options;
    const ends = picked.value?.kind === "spring" ? topology?.springs[picked.value.index] : null;
    measure((ends ?? marked.value).join(" "));
  };
  return (
    <details class="seldom" onToggle={(event) => event.currentTarget.open || measure("")}>
      <summary title="Distances and angles between particles">Measure</summary>
      <label class="field" title="Two particles: their distance. Three: the angle at the second one, too">
        <span>Particles</span>
        <input
          type="text"
          aria-label="Particles to measure"
          placeholder="0 5"
          value={text.value}
          onInput={(event) => measure(event.currentTarget.value)}
        />
      </label>
      <button
        type="button"
        class="small"
        title="The selected particles, or the ends of the picked spring"
        onClick={between}
      >
        Measure what is selected
      </button>
      {fault.value && (
        <p class="fault" role="alert">
          {fault.value}
        </p>
      )}
      {places.length > 1 && (
        <dl class="numbers" aria-label="Measured">
          {places.slice(1).map((place, i) => (
            <div key={i}>
              <dt>
                {chain[i]} to {chain[i + 1]}
              </dt>
              <dd>
                {measured(apart(places[i]!, place), unit)} ({apartBy(places[i]!, place)})
              </dd>
            </div>
          ))}
          {places.length > 2 && (
            <div>
              <dt>In total</dt>
              <dd>{measured(total(places), unit)}</dd>
            </div>
          )}
          {places.slice(2).map((place, i) => (
            <div key={`angle ${i}`}>
              <dt>Angle at {chain[i + 1]}</dt>
              <dd>{said(angle(places[i]!, places[i + 1]!, place))}°</dd>
            </div>
          ))}
        </dl>
      )}
      <label class="check" title={`Numbers of the selected particles on the canvas, at most ${MOST}`}>
        <input
          type="checkbox"
          checked={options.numbers.value}
          onChange={(event) => (options.numbers.value = event.currentTarget.checked)}
        />
        Show the numbers of selected particles
      </label>
    </details>
  );
}

/** Over the canvas: lines that are measured with their lengths, and numbers of particles. */
export function Labels({ studio }: { studio: Studio }) {
  const { session, options, view } = studio;
  void session.ticks.value;
  const turned = useSignal(0);
  const now = view.value;
  useEffect(() => now?.onMoved(() => (turned.value += 1)), [now]);
  void turned.value;
  const chain = options.measured.value;
  const shown = options.numbers.value ? options.marked.value.slice(0, MOST) : [];
  const canvas = document.querySelector(".drawing")?.getBoundingClientRect();
  const frame = shownFrame(studio);
  if (!now || !frame || !canvas || (chain.length < 2 && !shown.length)) return null;
  const place = (particle: number) => {
    const seen = now.project(particle);
    return seen && { x: seen.x - canvas.left, y: seen.y - canvas.top };
  };
  const unit = session.topology.value?.units.length ?? "";
  const { positions } = frame;
  return (
    <svg class="labels" role="img" aria-label="Measured lengths and numbers of particles">
      {chain.slice(1).map((to, i) => {
        const [a, b] = [place(chain[i]!), place(to)];
        if (!a || !b) return null;
        return (
          <g key={i}>
            <line x1={a.x} y1={a.y} x2={b.x} y2={b.y} />
            <text x={(a.x + b.x) / 2} y={(a.y + b.y) / 2 - 6}>
              {measured(apart(at(positions, chain[i]!), at(positions, to)), unit)}
            </text>
          </g>
        );
      })}
      {shown.map((particle) => {
        const seen = place(particle);
        return (
          seen && (
            <text key={particle} x={seen.x + 7} y={seen.y - 7} class="number">
              {particle}
            </text>
          )
        );
      })}
    </svg>
  );
}

const at = (positions: Float32Array, i: number) => [...positions.subarray(3 * i, 3 * i + 3)] as Point;

const apart = (a: Point, b: Point) => Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);

const apartBy = (a: Point, b: Point) => [..."xyz"].map((axis, i) => `${axis} ${said(b[i]! - a[i]!, 3)}`).join(", ");

const total = (places: Point[]) => places.slice(1).reduce((sum, place, i) => sum + apart(places[i]!, place), 0);

/** The angle at the second of three places [degrees]. */
function angle(a: Point, b: Point, c: Point): number {
  const [u, v] = [a.map((x, i) => x - b[i]!), c.map((x, i) => x - b[i]!)];
  const across = Math.hypot(
    u[1]! * v[2]! - u[2]! * v[1]!,
    u[2]! * v[0]! - u[0]! * v[2]!,
    u[0]! * v[1]! - u[1]! * v[0]!,
  );
  const along = u[0]! * v[0]! + u[1]! * v[1]! + u[2]! * v[2]!;
  return (Math.atan2(across, along) * 180) / Math.PI;
}
