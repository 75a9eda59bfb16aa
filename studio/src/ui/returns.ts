// What was lost when the connection comes back: what had been seen is compared with what there is now.
import { effect } from "@preact/signals";
import type { Session } from "../session";
import { tell } from "./notices";
import { measured } from "./words";

interface Seen {
  revision: number;
  iteration: number;
  time: number;
  playing: boolean;
}

/** Say so whenever a session that was lost comes back with less than was seen of it; gives how to end it. */
export function tellReturns(session: Session): () => void {
  let seen: Seen | null = null;
  let away = false;
  return effect(() => {
    void session.ticks.value;
    const { frame } = session;
    const live = session.connection.value === "live";
    const playing = session.summary.value?.playing ?? false;
    if (!live) {
      away ||= seen !== null;
      return;
    }
    if (!frame) return;
    const now = { revision: frame.revision, iteration: frame.iteration, time: frame.time, playing };
    if (away && seen) {
      const lost = losses(seen, now, session.topology.value?.units.time ?? "");
      if (lost.length) tell("Connected again, with a service that was started anew.", lost);
    }
    away = false;
    seen = now;
  });
}

function losses(seen: Seen, now: Seen, unit: string): string[] {
  const lost: string[] = [];
  if (now.revision < seen.revision)
    lost.push(`Edits after revision ${now.revision} are lost; ${seen.revision} was seen.`);
  if (now.iteration < seen.iteration) {
    lost.push(`${measured(seen.time, unit)} had been seen; it stands at ${measured(now.time, unit)}.`);
  }
  if (seen.playing && !now.playing) lost.push("It played and is paused now.");
  return lost;
}
