// The page of a session: the canvas, what drives it, and the panels.
import { effect, type Signal, signal } from "@preact/signals";
import { useEffect, useState } from "preact/hooks";
import { Session } from "../session";
import type { Variant } from "../variants";
import { takeUp } from "../view/kept";
import { type Options, options, type View } from "../view/types";
import { Bar } from "./bar";
import { Casing } from "./casing";
import { Designing } from "./designing";
import { Film } from "./film";
import { keepColours, keepGroups, keptColours, keptGroups } from "./kept";
import { following } from "./moved";
import { Panels } from "./panels";
import { arrive, entry } from "./place";
import { Pulse } from "./pulse";
import { Readings } from "./readings";
import { Rested } from "./rested";
import { sharing } from "./sharing";
import { Stage } from "./stage";
import { Traced } from "./traced";
import { Surfacing } from "./surfacing";
import { dark, remember, remembered } from "./theme";
import { calledOf } from "./words";

const LAYERS = "hookean-layers";

/** All that the parts of this page share. */
export interface Studio {
  session: Session;
  options: Options;
  /** Null until there is a canvas, and where the browser cannot draw. */
  view: Signal<View | null>;
  readings: Readings;
  rested: Rested;
  design: Designing;
  surfacing: Surfacing;
  film: Film;
  traced: Traced;
  casing: Casing;
  pulse: Pulse;
  /** The variant on a canvas of its own; null for none. */
  beside: Signal<Variant | null>;
}

export function SessionPage({ name }: { name: string }) {
  const [studio, setStudio] = useState<Studio | null>(null);
  useEffect(() => {
    const session = new Session(name);
    const chosen = options();
    chosen.layers.value = { ...chosen.layers.value, ...remembered(LAYERS, {}) };
    [chosen.groups.value, chosen.groupColours.value] = [keptGroups(name), keptColours(name)];
    const seen = takeUp(name, chosen);
    chosen.dark.value = dark.peek();
    // a read-only page leaves what this browser remembers of its owner as it is
    const forgets = session.readOnly ? [] : [
      effect(() => remember(LAYERS, chosen.layers.value)),
      effect(() => keepGroups(name, chosen.groups.value)),
      effect(() => keepColours(name, chosen.groupColours.value)),
    ];
    const readings = new Readings(session, chosen);
    const rested = new Rested(session, chosen);
    const design = new Designing(session);
    const surfacing = new Surfacing(session, chosen, seen?.surface);
    const film = new Film(session, chosen);
    const traced = new Traced(session, chosen, film);
    const casing = new Casing(session, chosen);
    const pulse = new Pulse(session);
    const read = { readings, rested, design, surfacing, film, traced, casing, pulse };
    setStudio({ session, options: chosen, view: signal(null), beside: signal(null), ...read });
    const stops = [sharing(session, chosen), following(session, chosen)];
    return () => {
      stops.forEach((stop) => stop());
      forgets.forEach((forget) => forget());
      Object.values(read).forEach((one) => one.dispose());
      session.close();
    };
  }, [name]);
  return studio && <Work studio={studio} />;
}

function Work({ studio }: { studio: Studio }) {
  const summary = studio.session.summary.value;
  const title = calledOf({ label: summary?.label ?? "", key: studio.session.key });
  useEffect(arrive, []);
  const locked = studio.session.connection.value === "locked";
  useEffect(() => {
    if (locked) entry.value = "out";
  }, [locked]);
  useEffect(() => {
    document.title = `${title} - hookean studio`;
  }, [title]);
  return (
    <div class="work">
      <Bar studio={studio} title={title} />
      <main id="main" class="stage" tabIndex={-1}>
        <Stage studio={studio} />
      </main>
      <Panels studio={studio} title={title} />
    </div>
  );
}
