// What was lost when the connection comes back: the last shown state is compared with the present one.
import { effect } from "@preact/signals";
import type { Frame } from "../frame";
import type { Session } from "../session";
import { tell } from "./notices";
import { measured } from "./words";

interface Seen {
  revision: number;
  iteration: number;
  time: number;
  playing: boolean;
}

/** Show a notice whenever a session that was lost or silent comes back with an older state; returns how to end it. */
export function tellReturns(session: Session): () => void {
  let seen: Seen | null = null;
  let away = false;
  let silent = false;
  let last: Frame | null = null;
  const unit = () => session.topology.value?.units.time ?? "";
  return effect(() => {
    void session.ticks.value;
    const { frame } = session;
    const live = session.connection.value === "live";
    const playing = session.summary.value?.playing ?? false;
    if (!live) {
      silent = session.connection.value === "silent";
      away ||= seen !== null && !silent;
      return;
    }
    if (!frame) return;
    const now = { revision: frame.revision, iteration: frame.iteration, time: frame.time, playing };
    if (silent && !away && seen && now.revision === seen.revision && now.iteration < seen.iteration)
      tell("The process of this session was restarted at its last checkpoint.", [since(seen, now, unit())]);
    if (away && seen) {
      const lost = losses(seen, now, unit());
      if (lost.length) tell("Reconnected; the service was restarted.", lost);
    }
    away = false;
    silent &&= frame === last; // until the first frame after the silence
    last = frame;
    seen = now;
  });
}

function losses(seen: Seen, now: Seen, unit: string): string[] {
  const lost: string[] = [];
  if (now.revision < seen.revision)
    lost.push(`Edits after revision ${now.revision} are lost (last shown: ${seen.revision}).`);
  if (now.iteration < seen.iteration) lost.push(since(seen, now, unit));
  if (seen.playing && !now.playing) lost.push("The session was playing and is now paused.");
  return lost;
}

const since = (seen: Seen, now: Seen, unit: string) =>
  `The time is ${measured(now.time, unit)} again (last shown: ${measured(seen.time, unit)}).`;
