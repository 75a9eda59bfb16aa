// Variants of the model, kept as branches of the session, and what differs: a table, an overlay, or side by side.
import { useSignal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import * as api from "../api";
import type { Summary } from "../model";
import { baseOf, labelOf, momentOf, ownOf, still, type Variant, variant } from "../variants";
import { form } from "../view/form";
import { apart, differences, type Row, sameUnits, type Side } from "./differences";
import { refuse, tell } from "./notices";
import { linkTo, met } from "./place";
import type { Studio } from "./studio";
import { dark } from "./theme";
import { Thumbnail } from "./thumbnail";
import { calledOf, measured, said } from "./words";

const AGAIN = 2000;
/** So many variants have a picture, and of no more particles than this. */
const [MOST, MANY] = [8, 20_000];

export type How = "overlay" | "beside" | "table";
const HOWS: [How, string, string][] = [
  ["overlay", "Overlay", "The lines of the variant over the form"],
  ["beside", "Side by side", "The variant on a canvas of its own; both are looked at from the same place"],
  ["table", "Table only", "Only the numbers"],
];

export function Compare({ studio }: { studio: Studio }) {
  const root = useRef<HTMLDivElement>(null);
  const { known, others, again } = useVariants(studio, root);
  const chosen = useSignal("");
  const how = useSignal<How>("overlay");
  const summary = studio.session.summary.value;
  const base = summary && baseOf(calledOf(summary));
  const [own, rest] = [true, false].map((is) => others.filter((one) => (baseOf(calledOf(one)) === base) === is));
  const variants = useRead(own!, others.find(({ key }) => key === chosen.value) ?? null);
  const found = variants.get(chosen.value) ?? null;
  useDrawn(studio, found, how.value);
  const choose = (key: string) => (chosen.value = chosen.value === key ? "" : key);
  return (
    <div class="compare" ref={root}>
      <Keep studio={studio} taken={own!} done={again} />
      {known && !own!.length && <p class="faint">No variants yet: keep the model as one, then change it.</p>}
      <ul class="variants">
        {own!.slice(0, MOST).map((other) => (
          <li key={other.key}>
            <button type="button" aria-pressed={chosen.value === other.key} onClick={() => choose(other.key)}>
              <Thumbnail variant={variants.get(other.key)} isDark={dark.value} />
              <span>{ownOf(calledOf(other))}</span>
            </button>
            <a href={linkTo(other.key)} aria-label={`Open ${ownOf(calledOf(other))}`}>
              Open
            </a>
          </li>
        ))}
      </ul>
      <Others sessions={[...own!.slice(MOST), ...rest!]} chosen={chosen.value} choose={choose} />
      {chosen.value && <Ways how={how.value} choose={(to) => (how.value = to)} />}
      {found && <Differences studio={studio} other={found} />}
    </div>
  );
}

/** The other sessions, read again while the panel is seen. */
function useVariants({ session }: Studio, root: { current: HTMLElement | null }) {
  const [others, setOthers] = useState<Summary[] | null>(null);
  const [turn, setTurn] = useState(0);
  useEffect(() => {
    let [here, timer] = [true, 0];
    const read = async () => {
      if (root.current?.checkVisibility() && session.connection.peek() === "live") {
        const found = await api.sessions().catch(met);
        if (!here) return;
        if (found) setOthers(found.sessions.filter(({ key }) => key !== session.key));
      }
      timer = window.setTimeout(() => void read(), AGAIN);
    };
    void read();
    const panel = root.current?.closest("details");
    const toggled = () => panel?.open && setTurn((now) => now + 1);
    panel?.addEventListener("toggle", toggled);
    return () => {
      here = false;
      clearTimeout(timer);
      panel?.removeEventListener("toggle", toggled);
    };
  }, [session, turn]);
  return { known: others !== null, others: others ?? [], again: () => setTurn((now) => now + 1) };
}

/** What is known of the first variants and of the chosen one, by key; read again where they have changed. */
function useRead(own: Summary[], chosen: Summary | null): ReadonlyMap<string, Variant> {
  const [read, setRead] = useState<ReadonlyMap<string, Variant>>(new Map());
  const asked = useRef(new Set<string>());
  useEffect(() => {
    const pictured = own.slice(0, MOST).filter(({ particles }) => particles <= MANY);
    for (const summary of new Set(chosen ? [chosen, ...pictured] : pictured)) {
      const moment = momentOf(summary);
      if (summary.playing || asked.current.has(moment)) continue;
      asked.current.add(moment);
      variant(summary)
        .then((found) => setRead((now) => new Map(now).set(summary.key, found)))
        .catch((error: unknown) => {
          asked.current.delete(moment);
          met(error);
          if (summary.key === chosen?.key) refuse(error, "The variant could not be read. ");
        });
    }
  }, [own, chosen]);
  return read;
}

/** Draw the chosen variant as wanted, until another is chosen. */
function useDrawn({ options, beside, session }: Studio, found: Variant | null, how: How): void {
  const length = session.topology.value?.units.length;
  useEffect(() => {
    const fits = found && found.topology.units.length === length;
    if (fits && how === "overlay") {
      const { springs, edges, strokes } = form(found.topology);
      options.ghost.value = {
        name: `Variant ${ownOf(calledOf(found.summary)).replace(/^variant /i, "")}`,
        positions: still(found).positions,
        ends: Int32Array.from([...springs, ...edges, ...strokes]),
      };
    }
    if (fits && how === "beside") beside.value = found;
    return () => {
      options.ghost.value = null;
      beside.value = null;
    };
  }, [options, found, how, length]);
}

function Keep({ studio: { session }, taken, done }: { studio: Studio; taken: Summary[]; done: () => void }) {
  const name = useSignal("");
  const busy = useSignal(false);
  const summary = session.summary.value;
  if (!summary) return null;
  const free = `variant ${taken.length + 1}`;
  const keep = async (event: Event) => {
    event.preventDefault();
    busy.value = true;
    try {
      const made = await api.branch(session.key, labelOf(calledOf(summary), name.value.trim() || free));
      tell(`${ownOf(calledOf(made))} was kept as a session of its own. Changes here leave it as it is.`);
      name.value = "";
      done();
    } catch (error) {
      met(error);
      refuse(error, "The variant was not kept. ");
    } finally {
      busy.value = false;
    }
  };
  return (
    <form class="row" onSubmit={(event) => void keep(event)}>
      <input
        type="text"
        aria-label="Name of the variant"
        title="A name for the model as it is now, such as high rise"
        maxLength={60}
        placeholder={free}
        value={name.value}
        onInput={(event) => (name.value = event.currentTarget.value)}
      />
      <button
        type="submit"
        title="A branch of this session with the present shape; this one goes on"
        disabled={busy.value || session.connection.value !== "live"}
      >
        Keep as a variant
      </button>
    </form>
  );
}

interface OfOthers {
  sessions: Summary[];
  chosen: string;
  choose: (key: string) => void;
}

function Others({ sessions, chosen, choose }: OfOthers) {
  if (!sessions.length) return null;
  return (
    <label class="field" title="A session of this service that is drawn over or beside this one, as a variant">
      <span>Other session</span>
      <select
        aria-label="Other session"
        value={sessions.some(({ key }) => key === chosen) ? chosen : ""}
        onChange={(event) => choose(event.currentTarget.value || chosen)}
      >
        <option value="">none</option>
        {sessions.map((other) => (
          <option key={other.key} value={other.key}>
            {calledOf(other)}
          </option>
        ))}
      </select>
    </label>
  );
}

function Ways({ how, choose }: { how: How; choose: (how: How) => void }) {
  return (
    <fieldset class="choices">
      <legend>Show the variant as</legend>
      {HOWS.map(([name, seen, hint]) => (
        <label key={name} title={hint}>
          <input type="radio" name="how" value={name} checked={how === name} onChange={() => choose(name)} />
          {seen}
        </label>
      ))}
    </fieldset>
  );
}

function Differences({ studio, other }: { studio: Studio; other: Variant }) {
  const { session, rested } = studio;
  const [topology, result, summary] = [session.topology.value, rested.result, session.summary.value];
  const wants = !result && !rested.isReading && summary?.playing === false;
  if (!topology || !result || !summary)
    return wants ? (
      <button type="button" class="small" onClick={() => rested.ask()}>
        Read the numbers
      </button>
    ) : (
      <p class="faint">The numbers are read when the form is at rest: press Solve or Pause.</p>
    );
  const mine: Side = { topology, result, summary };
  if (!sameUnits(mine, other))
    return <p class="faint">The variant has other units. Give both models the same units to compare them.</p>;
  const moved = apart(mine, other);
  const { length } = topology.units;
  return (
    <>
      <div class="scrolled" tabIndex={0} role="region" aria-label="Table of differences">
        <table>
          <thead>
            <tr>
              <th scope="col">Quantity</th>
              <th scope="col">This model</th>
              <th scope="col">{ownOf(calledOf(other.summary))}</th>
              <th scope="col">Difference</th>
            </tr>
          </thead>
          <tbody class="numbers">{differences(mine, other).map(rowOf)}</tbody>
        </table>
      </div>
      <p class="faint">
        {moved === null
          ? "The models have different numbers of particles, so their distances are not compared."
          : `Particles of the same number are up to ${measured(Number(moved.toPrecision(4)), length)} apart.`}
      </p>
    </>
  );
}

function rowOf({ name, unit, values, difference }: Row) {
  return (
    <tr key={name}>
      <th scope="row">
        {name} {unit && <span class="unit">[{unit}]</span>}
      </th>
      {values.map((value, i) => (
        <td key={i}>{typeof value === "number" ? said(value) : value}</td>
      ))}
      <td>{difference === null ? "" : said(difference)}</td>
    </tr>
  );
}
