// Tables of springs, particles and reactions: sorted, summed, saved as CSV, and a histogram that selects.
import { effect } from "@preact/signals";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Frame } from "../frame";
import { keep } from "./out";
import type { Studio } from "./studio";
import { type Bin, bins, type Column, counting, csv, type Named } from "./tabling";
import { sorted, sum, type Table, tabled, TABLES } from "./tabling";
import { counted, measured, said, titled } from "./words";

const ROWS = 100;
const BARS = 12;
const PAUSE = 1000; // ms between tables of a form that moves

const UNSORTED = { column: -1, isDown: false };

export function Tables({ studio }: { studio: Studio }) {
  const { session, options } = studio;
  const root = useRef<HTMLDivElement>(null);
  const frame = useShown(studio, root);
  const [what, setWhat] = useState<Named>("springs");
  const [asked, setBy] = useState(UNSORTED);
  const [only, setOnly] = useState<Bin | null>(null);
  const [topology, anchors, result] = [session.topology.value, session.anchors.value, studio.rested.result];
  const table = useMemo(() => {
    const fits = frame && topology && frame.positions.length === 3 * topology.particles;
    return fits ? tabled(what, { frame, topology, anchors, result }) : null;
  }, [what, frame, topology, anchors, result]);
  // a column may go while one looks: some are known at rest alone
  const by = asked.column < (table?.columns.length ?? 0) ? asked : UNSORTED;
  const order = useMemo(() => (table ? sorted(table, by.column, by.isDown) : []), [table, by]);
  const select = (bin: Bin | null) => {
    setOnly(bin);
    const rows = (bin?.places ?? []).map((place) => table!.rows[place]!);
    options.marked.value = table?.kind === "spring" ? rows.flatMap((i) => topology!.springs[i]!) : rows;
  };
  const show = (name: Named) => {
    select(null);
    setBy(UNSORTED);
    setWhat(name);
  };
  const column = table?.columns[counting(table, by.column)];
  const values = column?.values;
  const places = only && values ? order.filter((place) => only.holds(values[place]!)) : order;
  const save = () => keep(new Blob([csv(table!, places)], { type: "text/csv" }), `${session.key}-${what}.csv`);
  return (
    <div class="tables" ref={root}>
      <div class="row" role="group" aria-label="Table">
        {TABLES.map((name) => (
          <button
            key={name}
            type="button"
            title={`The table of ${name}; a click on a heading sorts it`}
            aria-pressed={name === what}
            onClick={() => show(name)}
          >
            {titled(name)}
          </button>
        ))}
        <button type="button" disabled={!places.length} title="Save these rows as a CSV file" onClick={save}>
          Save rows
        </button>
      </div>
      {table && column && <Histogram column={column} kind={table.kind} only={only} select={select} />}
      {table && (
        <Rows
          studio={studio}
          table={table}
          places={places}
          by={by}
          sort={(column) => {
            if (column !== by.column) select(null);
            setBy({ column, isDown: column === by.column ? !by.isDown : column >= 0 });
          }}
        />
      )}
    </div>
  );
}

/** The newest frame, once a second while the form moves, and only while the tables are seen. */
function useShown({ session }: Studio, root: { current: HTMLElement | null }): Frame | null {
  const [frame, setFrame] = useState<Frame | null>(null);
  useEffect(() => {
    let [last, at] = [null as Frame | null, 0];
    return effect(() => {
      void session.ticks.value;
      const now = session.frame;
      const isDue = !now?.playing || performance.now() - at > PAUSE;
      if (!now || now === last || !isDue || !root.current?.checkVisibility()) return;
      [last, at] = [now, performance.now()];
      setFrame(now);
    });
  }, [session]);
  return frame;
}

interface OfRows {
  studio: Studio;
  table: Table;
  places: number[];
  by: { column: number; isDown: boolean };
  sort: (column: number) => void;
}

function Rows({ studio: { options }, table, places, by, sort }: OfRows) {
  const picked = options.picked.value;
  const adds = table.columns.some((column) => column.adds);
  const head = (column: number, name: string, unit: string) => (
    <th key={name} scope="col" aria-sort={column !== by.column ? "none" : by.isDown ? "descending" : "ascending"}>
      <button type="button" title={`Sort by ${name}`} onClick={() => sort(column)}>
        {titled(name)} {unit && <span class="unit">[{unit}]</span>}
      </button>
    </th>
  );
  return (
    <>
      <div class="scrolled" tabIndex={0} role="region" aria-label={`Table of ${table.kind}s`}>
        <table>
          <thead>
            <tr>
              {head(-1, table.kind, "")}
              {table.columns.map(({ name, unit }, column) => head(column, name, unit))}
            </tr>
          </thead>
          <tbody class="numbers">
            {places.slice(0, ROWS).map((place) => {
              const index = table.rows[place]!;
              const isPicked = picked?.kind === table.kind && picked.index === index;
              return (
                <tr key={index} class={isPicked ? "picked" : ""}>
                  <th scope="row">
                    <button
                      type="button"
                      aria-pressed={isPicked}
                      aria-label={`Pick ${table.kind} ${index}`}
                      title={`Pick ${table.kind} ${index}`}
                      onClick={() => (options.picked.value = { kind: table.kind, index })}
                    >
                      {index}
                    </button>
                  </th>
                  {table.columns.map(({ name, values }) => (
                    <td key={name}>{said(values[place]!)}</td>
                  ))}
                </tr>
              );
            })}
          </tbody>
          {adds && (
            <tfoot class="numbers">
              <tr>
                <th scope="row">Sum</th>
                {table.columns.map(({ name, values, adds: isSum }) => (
                  <td key={name}>{isSum ? said(sum(places.map((place) => values[place]!))) : ""}</td>
                ))}
              </tr>
            </tfoot>
          )}
        </table>
      </div>
      <p class="faint">
        {counted(places.length, table.kind)}
        {places.length > ROWS && `; the first ${ROWS} are shown, the CSV file has all`}
      </p>
    </>
  );
}

interface OfBars {
  column: Column;
  kind: string;
  only: Bin | null;
  select: (bin: Bin | null) => void;
}

/** How many rows have which values; a bar selects its rows. */
function Histogram({ column, kind, only, select }: OfBars) {
  const found = useMemo(() => bins(column.values, BARS), [column.values]);
  const most = Math.max(1, ...found.map(({ places }) => places.length));
  if (!found.length) return null;
  const [low, high] = [found[0]!.low, found.at(-1)!.high];
  return (
    <>
      <div class="bars" role="group" aria-label={`Histogram of ${column.name}`}>
        {found.map((bin, i) => {
          const isOnly = only !== null && bin.low === only.low && bin.high === only.high;
          const range = `${said(bin.low, 3)} to ${measured(Number(bin.high.toPrecision(3)), column.unit)}`;
          const name = `${counted(bin.places.length, kind)} from ${range}`;
          return (
            <button
              key={i}
              type="button"
              title={`${name}; select them`}
              aria-label={name}
              aria-pressed={isOnly}
              disabled={!bin.places.length}
              onClick={() => select(isOnly ? null : bin)}
            >
              <span style={{ height: `${(100 * bin.places.length) / most}%` }} />
            </button>
          );
        })}
      </div>
      <p class="faint">
        {titled(column.name)} {said(low, 3)} to {measured(Number(high.toPrecision(3)), column.unit)}: click a bar to
        select its {kind}s.
      </p>
    </>
  );
}
