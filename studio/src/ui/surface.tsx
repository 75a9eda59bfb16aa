// The surface of the shape: colours of its faces, height lines, the ways of water, and the extremes of its numbers.
import type { SurfaceRead, Units } from "../model";
import { NumberField } from "./number";
import type { Studio } from "./studio";
import { type Chosen, type OfScalar, type Scalar, SCALARS, type Surfacing } from "./surfacing";
import { counted, measured, said } from "./words";

export function SurfacePanel({ studio }: { studio: Studio }) {
  const { surfacing, session, options } = studio;
  const topology = session.topology.value;
  const chosen = surfacing.chosen.value;
  const choose = (part: Partial<Chosen>) => (surfacing.chosen.value = { ...chosen, ...part });
  const paint = (scalar: Scalar | null) => {
    // one scale is read more easily than two
    const { colouring } = options;
    if (scalar && !chosen.scalar && colouring.value === "force") colouring.value = "plain";
    else if (!scalar && colouring.value === "plain") colouring.value = "force";
    choose({ scalar });
  };
  if (!topology) return null;
  const { units, forces } = topology;
  const isCloth = forces.some(({ kind }) => kind === "membrane");
  const hasFaces = Object.keys(topology.meshes).length > 0 || topology.geometry.some(({ faces }) => faces);
  if (!hasFaces)
    return <p class="faint">This model has no faces. A mesh in it, such as a membrane, has a surface to read.</p>;
  return (
    <>
      <fieldset class="choices">
        <legend>Colour faces by</legend>
        <label title="Faces in their own colour">
          <input
            type="radio"
            name="scalar"
            checked={chosen.scalar === null}
            onChange={() => paint(null)}
          />
          Nothing
        </label>
        {SCALARS.filter(({ isOfCloth }) => isCloth || !isOfCloth).map(({ name, seen, unit, hint }) => (
          <label key={name} title={unit(units) ? `${hint} [${unit(units)}]` : hint}>
            <input
              type="radio"
              name="scalar"
              checked={chosen.scalar === name}
              onChange={() => paint(name)}
            />
            {seen}
          </label>
        ))}
      </fieldset>
      <Lines chosen={chosen} choose={choose} length={units.length} step={surfacing.read.value?.heights.step ?? null} />
      <Found studio={studio} surfacing={surfacing} units={units} />
      {surfacing.fault.value && (
        <p class="fault" role="alert">
          {surfacing.fault.value}
        </p>
      )}
    </>
  );
}

interface OfLines {
  chosen: Chosen;
  choose: (part: Partial<Chosen>) => void;
  length: string;
  step: number | null;
}

function Lines({ chosen, choose, length, step }: OfLines) {
  return (
    <div class="lines">
      <label class="check" title="Lines of equal height, at multiples of the step">
        <input
          type="checkbox"
          checked={chosen.heights}
          onChange={(event) => choose({ heights: event.currentTarget.checked })}
        />
        Height lines
      </label>
      {chosen.heights && (
        <NumberField
          name="Step of height lines"
          seen="Every"
          value={chosen.step}
          unit={length}
          placeholder={step === null ? "round" : said(step)}
          hint="From height line to height line. Empty: a round length, for 20 lines at most"
          bounds={{ more_than: 0 }}
          done={(value) => choose({ step: value })}
        />
      )}
      <label
        class="check"
        title="200 drops, each from the middle of a face down along the steepest way, to the edge or to where it stays"
      >
        <input
          type="checkbox"
          checked={chosen.water}
          onChange={(event) => choose({ water: event.currentTarget.checked })}
        />
        Water
      </label>
    </div>
  );
}

interface OfFound {
  studio: Studio;
  surfacing: Surfacing;
  units: Units;
}

/** The extremes of what is coloured, and what became of the drops. */
function Found({ studio, surfacing, units }: OfFound) {
  const [read, chosen] = [surfacing.read.value, surfacing.chosen.value];
  if (!read) return null;
  const one = SCALARS.find(({ name }) => name === chosen.scalar);
  return (
    <>
      {one && <Ends studio={studio} scalar={one} values={read[one.name]} unit={one.unit(units)} />}
      {chosen.water && read.water.stays.length > 0 && <p role="status">{drops(read)}</p>}
    </>
  );
}

function drops({ water: { stays } }: SurfaceRead): string {
  const staying = stays.filter(Boolean).length;
  if (!staying) return `All ${counted(stays.length, "drop")} run off.`;
  return `${staying} of ${counted(stays.length, "drop")} stay, in a hollow or on a level face: their ways are red.`;
}

interface OfEnds {
  studio: Studio;
  scalar: OfScalar;
  values: (number | null)[];
  unit: string;
}

function Ends({ studio: { options }, scalar, values, unit }: OfEnds) {
  let [low, high] = [-1, -1];
  values.forEach((value, i) => {
    if (value === null) return;
    if (low < 0 || value < values[low]!) low = i;
    if (high < 0 || value > values[high]!) high = i;
  });
  if (low < 0) {
    const why = scalar.isOfCloth
      ? "its membrane has no strength; give it a material that has one."
      : "all its particles are on the boundary.";
    return (
      <p class="faint">
        {scalar.seen} is undefined on this surface: {why}
      </p>
    );
  }
  const row = (seen: string, at: number) => (
    <div>
      <dt>{seen}</dt>
      <dd>
        {measured(Number(values[at]!.toPrecision(4)), unit)} at{" "}
        <button
          type="button"
          class="small"
          title="Pick this particle"
          onClick={() => (options.picked.value = { kind: "particle", index: at })}
        >
          particle {at}
        </button>
      </dd>
    </div>
  );
  return (
    <dl>
      {row("Smallest", low)}
      {row("Largest", high)}
    </dl>
  );
}
