// The present view as a drawing of lines, and as a picture with its legend.
import { extremes } from "../view/extremes";
import type { Form } from "../view/form";
import { round } from "../view/plane";
import type { Legend, View } from "../view/types";
import { measured, said } from "./words";

/** What a drawing says beside the form. */
export interface Captions {
  title: string;
  legend: Legend | null;
  /** The longest arrows, as "Load up to 1 kN". */
  arrows: string[];
  /** A length and how long it is drawn [CSS pixels]; null in perspective, where no length is true. */
  bar?: { said: string; pixels: number } | null;
}

/** The lines of the form as they are seen, as SVG; particles that are held are squares. */
export function svg(view: View, form: Form, held: Iterable<number>, title: string): Blob {
  const seen = Array.from({ length: form.particles }, (_, i) => view.project(i));
  const places = seen.filter((place) => place !== null);
  if (!places.length) throw new Error("Nothing of the form is in view; press Fit.");
  const margin = 20;
  const [left, top] = [Math.min(...places.map(({ x }) => x)), Math.min(...places.map(({ y }) => y))];
  const [right, bottom] = [Math.max(...places.map(({ x }) => x)), Math.max(...places.map(({ y }) => y))];
  const near = (value: number) => Number(value.toFixed(2));
  const [x, y] = [(i: number) => near(seen[i]!.x - left + margin), (i: number) => near(seen[i]!.y - top + margin)];
  const lines = (ends: Int32Array, name: string, width: number) => {
    const drawn: string[] = [];
    for (let k = 0; k < ends.length; k += 2) {
      const [a, b] = [ends[k]!, ends[k + 1]!];
      if (seen[a] && seen[b]) drawn.push(`<line x1="${x(a)}" y1="${y(a)}" x2="${x(b)}" y2="${y(b)}"/>`);
    }
    return drawn.length ? `<g id="${name}" stroke="black" stroke-width="${width}">${drawn.join("\n")}</g>` : "";
  };
  const squares = [...held]
    .filter((i) => seen[i])
    .map((i) => `<rect x="${x(i) - 3}" y="${y(i) - 3}" width="6" height="6"/>`);
  const [width, height] = [near(right - left + 2 * margin), near(bottom - top + 2 * margin)];
  const text = [
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}">`,
    `<title>${escaped(title)}</title>`,
    lines(Int32Array.from([...form.edges, ...form.strokes]), "edges", 0.5),
    lines(form.springs, "springs", 1),
    squares.length ? `<g id="held">${squares.join("\n")}</g>` : "",
    "</svg>",
  ];
  return new Blob([text.filter(Boolean).join("\n")], { type: "image/svg+xml" });
}

const ESCAPES: Record<string, string> = { "&": "&amp;", "<": "&lt;", ">": "&gt;" };

const escaped = (text: string) => text.replace(/[&<>]/g, (letter) => ESCAPES[letter]!);

/** What is seen on a canvas of a width [CSS pixels], in full quality, with title and legend in its corner. */
export async function picture(view: View, captions: Captions, isDark: boolean, width: number): Promise<Blob> {
  const drawn = await createImageBitmap(await view.png());
  const canvas = new OffscreenCanvas(drawn.width, drawn.height);
  const pen = canvas.getContext("2d")!;
  pen.drawImage(drawn, 0, 0);
  caption(pen, captions, isDark, drawn.width / width);
  drawn.close();
  return canvas.convertToBlob({ type: "image/png" });
}

const BAR = 120;
const PARALLEL = 1; // degrees of the angle seen: less is a plan, a front or a side

/** Width, depth and height of what is drawn, in words. */
export function sizeOf(positions: ArrayLike<number>, unit: string): string {
  const sides = [0, 1, 2].map((axis) => {
    const along = Array.from({ length: positions.length / 3 }, (_, i) => positions[3 * i + axis]!);
    const [low, high] = extremes(along);
    return said(Number.isNaN(low) ? 0 : high - low, 3);
  });
  return `Size ${sides.join(" x ")} ${unit}`;
}

/** A bar of a round length for a view without perspective on a canvas of a height [CSS pixels]. */
export function barOf(view: View, height: number, unit: string): Captions["bar"] {
  const place = view.place();
  if (place.angle > PARALLEL) return null;
  const pixel = place.height / Math.max(1, height);
  const length = round(BAR * pixel) / (round(BAR * pixel) > BAR * pixel * 1.6 ? 2 : 1);
  return { said: measured(length, unit), pixels: length / pixel };
}

const [LINE, RAMP, LEFT] = [20, 160, 16];

export function caption(
  pen: OffscreenCanvasRenderingContext2D,
  { title, legend, arrows, bar = null }: Captions,
  isDark: boolean,
  scale: number,
): void {
  pen.scale(scale, scale);
  pen.fillStyle = isDark ? "#e6eaec" : "#1a2124";
  pen.textBaseline = "top";
  let y = LEFT;
  const write = (text: string, font = "13px system-ui, sans-serif") => {
    pen.font = font;
    pen.fillText(text, LEFT, y);
    y += LINE;
  };
  write(title, "600 15px system-ui, sans-serif");
  const unit = legend && legend.unit !== "-" ? legend.unit : "";
  if (legend && legend.equal !== null) write(`${legend.title}: all equal, ${measured(legend.equal, unit)}`);
  else if (legend) {
    write(unit ? `${legend.title} [${unit}]` : legend.title);
    const ink = pen.fillStyle;
    const colours = pen.createLinearGradient(LEFT, 0, LEFT + RAMP, 0);
    legend.colours.forEach((colour, i) => colours.addColorStop(i / Math.max(1, legend.colours.length - 1), colour));
    pen.fillStyle = colours;
    pen.fillRect(LEFT, y, RAMP, 10);
    pen.fillStyle = ink;
    y += 14;
    write(said(legend.low, 3));
    pen.fillText(said(legend.high, 3), LEFT + RAMP - pen.measureText(said(legend.high, 3)).width, y - LINE);
  }
  arrows.forEach((sentence) => write(sentence));
  if (!bar) return;
  pen.fillRect(LEFT, y + 6, bar.pixels, 2);
  for (const x of [LEFT, LEFT + bar.pixels - 1]) pen.fillRect(x, y + 2, 1, 10);
  y += 14;
  write(bar.said);
}
