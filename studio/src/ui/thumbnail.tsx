// A small picture of a session: its lines from aside and above, in the colours of their forces.
import { useEffect, useRef } from "preact/hooks";
import { palette, ramp } from "../view/colours";
import { form } from "../view/form";
import { springForces, type Variant } from "../variants";

const [WIDTH, HEIGHT, MARGIN] = [96, 64, 6];
const [AZIMUTH, ELEVATION] = [-Math.PI / 3, Math.PI / 6.4];
const FINE = 2; // pixels for each CSS pixel

export function Thumbnail({ variant, isDark }: { variant: Variant | undefined; isDark: boolean }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const context = canvas.current?.getContext("2d");
    if (context && variant) draw(context, variant, isDark);
  }, [variant, isDark]);
  return <canvas ref={canvas} class="thumbnail" width={FINE * WIDTH} height={FINE * HEIGHT} aria-hidden="true" />;
}

function draw(context: CanvasRenderingContext2D, variant: Variant, isDark: boolean): void {
  const { springs, edges, strokes } = form(variant.topology);
  const places = flat(variant.result.particles);
  const forces = springForces(variant);
  const known = forces.filter(Number.isFinite);
  const { colours, first, last } = ramp(Math.min(...known), Math.max(...known), isDark);
  const { plain, ground } = palette(isDark);
  context.fillStyle = ground;
  context.fillRect(0, 0, FINE * WIDTH, FINE * HEIGHT);
  context.lineWidth = springs.length > 2000 ? 0.6 : 1.4;
  const line = (a: number, b: number, colour: string) => {
    context.strokeStyle = colour;
    context.beginPath();
    context.moveTo(...places[a]!);
    context.lineTo(...places[b]!);
    context.stroke();
  };
  for (const pairs of [edges, strokes]) for (let i = 0; i < pairs.length; i += 2) line(pairs[i]!, pairs[i + 1]!, plain);
  for (let i = 0; 2 * i < springs.length; i++) {
    const part = ((forces[i]! - first) / (last - first)) * (colours.length - 1);
    line(springs[2 * i]!, springs[2 * i + 1]!, colours[Math.round(part)] ?? plain);
  }
}

/** Where particles are on the picture. */
function flat(particles: [number, number, number][]): [number, number][] {
  const [sine, cosine] = [Math.sin(AZIMUTH), Math.cos(AZIMUTH)];
  const seen = particles.map(([x, y, z]): [number, number] => {
    const towards = x * cosine + y * sine;
    return [y * cosine - x * sine, towards * Math.sin(ELEVATION) - z * Math.cos(ELEVATION)];
  });
  const ends = [0, 1].map((axis) =>
    seen.reduce(([a, b], p) => [Math.min(a!, p[axis]!), Math.max(b!, p[axis]!)], [Infinity, -Infinity]),
  ) as [number, number][];
  const [[left, right], [top, bottom]] = ends as [[number, number], [number, number]];
  const room = [WIDTH - 2 * MARGIN, HEIGHT - 2 * MARGIN].map((size) => FINE * size);
  const scale = Math.min(room[0]! / (right - left || 1), room[1]! / (bottom - top || 1));
  return seen.map(([x, y]) => [
    0.5 * FINE * WIDTH + scale * (x - 0.5 * (left + right)),
    0.5 * FINE * HEIGHT + scale * (y - 0.5 * (top + bottom)),
  ]);
}
