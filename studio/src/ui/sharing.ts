// What this page shares with programs that show something in it: what is picked here, and colours from there.
import { effect } from "@preact/signals";
import * as api from "../api";
import type { Shared, Topology } from "../model";
import type { Session } from "../session";
import type { Given, Options } from "../view/types";

/** Share from now on; returns how to stop it. */
export function sharing(session: Session, options: Options): () => void {
  let told: Shared["colours"] = null;
  let isFirst = true;
  const show = () => {
    const topology = session.topology.peek();
    const before = options.given.peek();
    const given = told && topology ? coloured(told, topology) : null;
    if (!given && !before) return;
    options.given.value = given;
    if (given) options.colouring.value = "given";
    else if (options.colouring.peek() === "given") options.colouring.value = "force";
  };
  const read = async () => {
    try {
      told = (await api.shared(session.key)).colours;
      show();
    } catch {
      // the connection shows what is wrong; the next change asks again
    }
  };
  const stops = [
    effect(() => {
      if (session.views.value > 0 && session.connection.value === "live") void read();
    }),
    effect(() => {
      void session.topology.value;
      show();
    }),
    effect(() => {
      const picked = options.picked.value;
      const tells = !isFirst && !session.readOnly && session.connection.peek() === "live";
      if (tells) void api.share(session.key, { picked }).catch(() => undefined);
      isFirst = false;
    }),
  ];
  return () => stops.forEach((stop) => stop());
}

/** Colours of the springs of a topology; null where they are of another one. A spring has the mean of its ends. */
function coloured({ title, unit, of, values }: NonNullable<Shared["colours"]>, topology: Topology): Given | null {
  if (values.length !== (of === "springs" ? topology.springs.length : topology.particles)) return null;
  if (of === "springs") return { title, unit, values: Float32Array.from(values) };
  const means = Float32Array.from(topology.springs, ([a, b]) => (values[a]! + values[b]!) / 2);
  return { title, unit, values: means };
}
