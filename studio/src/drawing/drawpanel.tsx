// The panel Draw: what the pen draws, in which plane, to what it snaps, and what lines and faces become.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { know } from "../ui/catalogue";
import { NumberField } from "../ui/number";
import type { Studio } from "../ui/studio";
import { usual } from "../ui/usual";
import { Become, type Chosen, forceOf } from "./become";
import { stepOf } from "./blank";
import { Change } from "./change";
import { type Mode, type Pen, penOf } from "./pen";
import { NAMES, type Snapping, typedPoint, type Working } from "./snap";

const MODES: [Mode, string, string][] = [
  ["point", "Points", "Each click adds a particle"],
  ["line", "Lines", "Each click adds a corner and the line that leads to it; Esc ends the line"],
  ["face", "Faces", "Four clicks make a face; three and Enter a triangle"],
];

const SNAPS: [keyof Omit<Snapping, "step">, string, string][] = [
  ["particles", "Particles", "A click near a particle uses it"],
  ["midpoints", "Midpoints", "A click near the middle of a spring divides the spring there"],
  ["grid", "Grid", "Other clicks go to the nearest corner of the grid"],
];

export function DrawPanel({ studio }: { studio: Studio }) {
  const { session, options } = studio;
  const pen = penOf(studio);
  const units = session.topology.value?.units ?? { length: "m", force: "N", time: "s" };
  const lines = useSignal<Chosen>({ kind: "springs", name: "", typed: {} });
  const faces = useSignal<Chosen>({ kind: "membrane", name: "", typed: {} });
  useEffect(() => {
    know().catch(() => undefined); // the list of forces reports it
  }, []);
  useEffect(() => {
    pen.snapping.value = { ...pen.snapping.value, step: stepOf(units.length) };
    if (!faces.value.name) faces.value = { ...faces.value, typed: usual(faces.value.kind, units) };
  }, [units.length, units.force]);
  pen.lines = () => forceOf("lines", lines.value);
  pen.faces = () => forceOf("faces", faces.value);
  const isBlank = session.topology.value?.particles === 0;
  useEffect(() => {
    if (isBlank) options.tool.value = "draw";
  }, [isBlank]);
  const isOn = options.tool.value === "draw";
  const choose = (mode: Mode) => {
    const isSame = isOn && pen.mode.value === mode;
    pen.choose(mode);
    options.tool.value = isSame ? "none" : "draw";
  };
  return (
    <>
      <div class="row" role="group" aria-label="Draw with clicks">
        {MODES.map(([mode, seen, hint]) => (
          <button
            key={mode}
            type="button"
            class="small"
            title={hint}
            aria-pressed={isOn && pen.mode.value === mode}
            onClick={() => choose(mode)}
          >
            {seen}
          </button>
        ))}
      </div>
      {isOn && <Typed pen={pen} unit={units.length} />}
      <Plane pen={pen} unit={units.length} />
      {(!isOn || pen.mode.value === "line") && <Become of="lines" chosen={lines} units={units} />}
      {(!isOn || pen.mode.value === "face") && <Become of="faces" chosen={faces} units={units} />}
      <Change studio={studio} pen={pen} />
    </>
  );
}

/** The next corner by its coordinates. */
function Typed({ pen, unit }: { pen: Pen; unit: string }) {
  const text = useSignal("");
  const put = (event: Event) => {
    event.preventDefault();
    if (!text.value.trim()) return void pen.finish();
    const at = typedPoint(text.value, pen.last.value?.at ?? null);
    if (typeof at === "string") return void (pen.fault.value = at);
    text.value = "";
    void pen.put({ at, what: "typed", index: -1 });
  };
  return (
    <form class="typed" onSubmit={put}>
      <label class="field wide" title="x y z of the next corner; @ before them: from the last corner. Enter puts it">
        <span>Next corner [{unit}]</span>
        <input
          id="next-corner"
          type="text"
          autocomplete="off"
          aria-label={`Next corner [${unit}]`}
          placeholder="4 0 2.5 or @1 0 0"
          value={text.value}
          onInput={(event) => (text.value = event.currentTarget.value)}
          onKeyDown={(event) => {
            if (event.key === "Escape") pen.end();
          }}
        />
      </label>
      {pen.fault.value && (
        <p class="fault" role="alert">
          {pen.fault.value}
        </p>
      )}
      <p class="note" role="status">
        {saidOfCorners(pen)}
      </p>
    </form>
  );
}

function saidOfCorners(pen: Pen): string {
  const put = pen.corners.value.length;
  if (pen.mode.value === "point") return "Click on the canvas, or type coordinates. Drag to turn the view.";
  if (!put) return "Click the first corner on the canvas, or type its coordinates. Drag to turn the view.";
  if (pen.mode.value === "line") return "Click the next corner. Enter or Esc ends the line.";
  if (put === 3) return "Click the fourth corner, or press Enter for a triangle.";
  return "Click the next corner. Esc drops them.";
}

/** The working plane and what the pen snaps to. */
function Plane({ pen, unit }: { pen: Pen; unit: string }) {
  const [working, snapping] = [pen.working.value, pen.snapping.value];
  return (
    <>
      <label class="field" title="The plane in which clicks beside the model lie">
        <span>Working plane</span>
        <select
          aria-label="Working plane"
          value={working.axis}
          onChange={(event) => (pen.working.value = { axis: event.currentTarget.value as Working["axis"], at: 0 })}
        >
          {Object.entries(NAMES).map(([axis, seen]) => (
            <option key={axis} value={axis}>
              {seen}
            </option>
          ))}
        </select>
      </label>
      <div class="row pair">
        <NumberField
          name={`Working plane at ${working.axis}`}
          seen={`At ${working.axis}`}
          unit={unit}
          hint="Where the plane crosses this axis; 0 is through the origin"
          value={working.at}
          done={(at) => (pen.working.value = { ...working, at: at ?? 0 })}
        />
        <NumberField
          name="Step of the grid"
          seen="Step"
          unit={unit}
          hint="Distance of the lines of the grid; usually the size of a panel or a part of it"
          value={snapping.step}
          bounds={{ more_than: 0 }}
          done={(step) => step && (pen.snapping.value = { ...snapping, step })}
        />
      </div>
      <fieldset class="choices">
        <legend>Snap to</legend>
        {SNAPS.map(([name, seen, hint]) => (
          <label key={name} title={hint}>
            <input
              type="checkbox"
              checked={snapping[name]}
              onChange={(event) => (pen.snapping.value = { ...snapping, [name]: event.currentTarget.checked })}
            />
            {seen}
          </label>
        ))}
      </fieldset>
    </>
  );
}
