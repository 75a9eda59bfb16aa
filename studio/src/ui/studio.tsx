// The page of a session: the canvas, what drives it, and the panels.
import { type Signal, signal } from "@preact/signals";
import { useEffect, useState } from "preact/hooks";
import { Session } from "../session";
import { type Options, options, type View } from "../view/types";
import { Bar } from "./bar";
import { Panels } from "./panels";
import { entry } from "./place";
import { Stage } from "./stage";

/** All that the parts of this page share. */
export interface Studio {
  session: Session;
  options: Options;
  /** Null until there is a canvas, and where the browser cannot draw. */
  view: Signal<View | null>;
}

export function SessionPage({ name }: { name: string }) {
  const [studio, setStudio] = useState<Studio | null>(null);
  useEffect(() => {
    const session = new Session(name);
    setStudio({ session, options: options(), view: signal(null) });
    return () => session.close();
  }, [name]);
  return studio && <Work studio={studio} />;
}

function Work({ studio }: { studio: Studio }) {
  const summary = studio.session.summary.value;
  const title = summary?.label || studio.session.key;
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
