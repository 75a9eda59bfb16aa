// What was lost when the connection comes back: the last shown state is compared with the present one.
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

/** Show a notice whenever a lost session comes back with an older state; returns how to end this. */
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
      if (lost.length) tell("Reconnected; the service was restarted.", lost);
    }
    away = false;
    seen = now;
  });
}

function losses(seen: Seen, now: Seen, unit: string): string[] {
  const lost: string[] = [];
  if (now.revision < seen.revision)
    lost.push(`Edits after revision ${now.revision} are lost (last shown: ${seen.revision}).`);
  if (now.iteration < seen.iteration) {
    lost.push(`The time is ${measured(now.time, unit)} again (last shown: ${measured(seen.time, unit)}).`);
  }
  if (seen.playing && !now.playing) lost.push("It was playing and is now paused.");
  return lost;
}
