// Over the canvas while particles are selected by a box or a line around them.
import { useSignal } from "@preact/signals";
import { type Place, box } from "../view/sets";
import { joined } from "../view/faces";
import type { Options, Tool } from "../view/types";
import type { Studio } from "./studio";

const APART = 4;

export function Selecting({ studio: { options, view } }: { studio: Studio }) {
  const line = useSignal<Place[]>([]);
  const tool = options.tool.value;
  if (tool !== "box" && tool !== "lasso") return null;
  const place = (event: PointerEvent): Place => {
    const { left, top } = (event.currentTarget as Element).getBoundingClientRect();
    return { x: event.clientX - left, y: event.clientY - top };
  };
  const press = (event: PointerEvent) => {
    (event.currentTarget as Element).setPointerCapture(event.pointerId);
    line.value = [place(event)];
  };
  const lead = (event: PointerEvent) => {
    const [first] = line.value;
    const last = line.value.at(-1);
    const now = place(event);
    if (!first || !last || (tool === "lasso" && Math.hypot(now.x - last.x, now.y - last.y) < APART)) return;
    line.value = tool === "lasso" ? [...line.value, now] : [first, now];
  };
  const end = (event: PointerEvent) => {
    const drawn = outline(tool, line.value);
    line.value = [];
    if (drawn.length < 3) return;
    if (options.element.value === "faces") {
      const faces = view.value?.facesInside(drawn) ?? [];
      const isAdded = !event.altKey;
      const kept = event.shiftKey || event.altKey ? options.markedFaces.value : [];
      options.markedFaces.value = joined(kept, faces, isAdded);
      return;
    }
    const found = view.value?.inside(drawn) ?? [];
    const before = new Set(options.marked.value);
    if (event.shiftKey) found.forEach((particle) => before.add(particle));
    else if (event.altKey) found.forEach((particle) => before.delete(particle));
    options.picked.value = null;
    options.marked.value = event.shiftKey || event.altKey ? [...before].sort((a, b) => a - b) : found;
  };
  const points = outline(tool, line.value).map(({ x, y }) => `${x},${y}`);
  return (
    <svg
      class="selecting"
      data-testid="selecting"
      aria-hidden="true"
      onPointerDown={press}
      onPointerMove={lead}
      onPointerUp={end}
      onPointerCancel={() => (line.value = [])}
    >
      <polygon points={points.join(" ")} />
    </svg>
  );
}

const outline = (tool: string, line: Place[]) =>
  tool === "box" && line.length === 2 ? box(line[0]!, line[1]!) : tool === "box" ? [] : line;

const TOOLS: [Tool, string, string][] = [
  ["box", "Box", "Drag a box on the canvas; Shift adds, Alt takes away"],
  ["lasso", "Lasso", "Draw a line on the canvas around what to select; Shift adds, Alt takes away"],
];

/** The buttons of these tools. */
export const enclosedBy = (options: Options) =>
  TOOLS.map(([tool, seen, hint]) => (
    <button
      key={tool}
      type="button"
      class="small"
      title={hint}
      aria-pressed={options.tool.value === tool}
      onClick={() => (options.tool.value = options.tool.value === tool ? "none" : tool)}
    >
      {seen}
    </button>
  ));
