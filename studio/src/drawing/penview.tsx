// Over the canvas while the pen draws: where the next corner would be, and what it snaps to.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Point } from "../model";
import type { Studio } from "../ui/studio";
import { measured, said } from "../ui/words";
import { type Pen, penOf } from "./pen";
import { projector, saidOf, type Sight, spotAt } from "./snap";

const MOUSE = { snap: 12, still: 4 };
const FINGER = { snap: 24, still: 9 };

export function PenView({ studio }: { studio: Studio }) {
  const { options, view, session } = studio;
  const pen = penOf(studio);
  const isOn = options.tool.value === "draw";
  const turned = useSignal(0);
  const now = view.value;
  useEffect(() => (isOn && now ? follow(studio, pen) : undefined), [studio, isOn, now]);
  useEffect(() => (isOn ? now?.onMoved(() => (turned.value += 1)) : undefined), [isOn, now]);
  const { axis, at } = pen.working.value;
  const { step } = pen.snapping.value;
  useEffect(() => {
    options.working.value = isOn ? { axis, at, step } : null;
    return () => void (options.working.value = null);
  }, [isOn, axis, at, step]);
  void turned.value;
  void session.ticks.value;
  const sight = now && isOn ? sightOf(studio) : null;
  if (!sight) return null;
  const seen = projector(sight);
  const spot = pen.spot.value;
  const place = spot && seen(spot.at);
  const last = pen.last.value;
  const from = last && seen(last.at);
  const corners = pen.mode.value === "face" ? pen.corners.value.map((corner) => seen(corner.at)) : [];
  const outline = [...corners, ...(corners.length ? [place] : [])].flatMap((p) => (p ? [`${p.x},${p.y}`] : []));
  const unit = session.topology.value?.units.length ?? "";
  return (
    <svg class="pen" role="img" aria-label={spot ? `The pen is on ${saidOf(spot)}` : "The pen"}>
      {outline.length > 1 && <polygon points={outline.join(" ")} />}
      {from && place && pen.mode.value === "line" && <line x1={from.x} y1={from.y} x2={place.x} y2={place.y} />}
      {spot && place && (
        <g class={spot.what}>
          {spot.what === "particle" && <circle cx={place.x} cy={place.y} r="9" />}
          {spot.what === "midpoint" && <path d={`M${place.x} ${place.y - 9}l8 15h-16z`} />}
          {(spot.what === "grid" || spot.what === "plane") && (
            <path d={`M${place.x - 8} ${place.y}h16M${place.x} ${place.y - 8}v16`} />
          )}
          <text x={place.x + 13} y={place.y - 11}>
            {saidOf(spot)}
          </text>
          <text x={place.x + 13} y={place.y + 5} class="small">
            {spot.at.map((value) => said(value, 4)).join("  ")}
            {last && ` · ${measured(apart(last.at, spot.at), unit)}`}
          </text>
        </g>
      )}
    </svg>
  );
}

const apart = (a: Point, b: Point) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

function sightOf({ view }: Studio): (Sight & { canvas: HTMLCanvasElement }) | null {
  const canvas = document.querySelector<HTMLCanvasElement>(".drawing > canvas");
  if (!canvas || !view.value) return null;
  return { canvas, camera: view.value.camera, width: canvas.clientWidth, height: canvas.clientHeight };
}

/** Follow the pointer and the keys on the canvas; returns how to stop it. A press that moves turns the view. */
function follow(studio: Studio, pen: Pen): () => void {
  const sight = sightOf(studio);
  if (!sight) return () => undefined;
  const { canvas } = sight;
  const end = new AbortController();
  const on = { signal: end.signal, capture: true };
  let press: { x: number; y: number; id: number } | null = null;
  const aim = (event: PointerEvent) => {
    const { left, top } = canvas.getBoundingClientRect();
    const { snap } = event.pointerType === "touch" ? FINGER : MOUSE;
    const springs = studio.session.topology.value?.springs ?? [];
    const among = { ...(sightOf(studio) ?? sight), positions: studio.view.value!.particles(), springs };
    const at: [number, number] = [event.clientX - left, event.clientY - top];
    return (pen.spot.value = spotAt(at, snap, pen.working.value, pen.snapping.value, among));
  };
  canvas.addEventListener(
    "pointerdown",
    (event) => {
      const { clientX: x, clientY: y, pointerId: id } = event;
      press = event.button === 0 && event.isPrimary ? { x, y, id } : null;
    },
    on,
  );
  canvas.addEventListener("pointermove", (event) => void (event.buttons ? (pen.spot.value = null) : aim(event)), on);
  canvas.addEventListener("pointerleave", () => (pen.spot.value = null), on);
  canvas.addEventListener(
    "pointerup",
    (event) => {
      const { still } = event.pointerType === "touch" ? FINGER : MOUSE;
      const { clientX: x, clientY: y, pointerId: id } = event;
      const isClick = press?.id === id && Math.hypot(x - press.x, y - press.y) <= still;
      press = null;
      const spot = isClick ? aim(event) : null;
      if (spot) void pen.put(spot);
    },
    on,
  );
  canvas.addEventListener("keydown", (event) => pressed(event, studio, pen), on);
  canvas.style.cursor = "crosshair";
  return () => {
    end.abort();
    pen.spot.value = null;
    pen.end();
    canvas.style.cursor = "";
  };
}

/** Enter and Esc end a line or a face, a second Esc puts the pen away; a digit begins to type coordinates. */
function pressed(event: KeyboardEvent, { options }: Studio, pen: Pen): void {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === "Enter") void pen.finish();
  else if (event.key === "Escape" && pen.corners.value.length) pen.end();
  else if (event.key === "Escape") options.tool.value = "none";
  else if (/^[\d.@-]$/.test(event.key)) return document.getElementById("next-corner")?.focus();
  else return;
  event.preventDefault();
  event.stopPropagation();
}
