// Groups and selections where particles get other numbers, as when some are deleted: they keep the same particles.
import { effect } from "@preact/signals";
import type { Topology } from "../model";
import type { Session } from "../session";
import type { Options } from "../view/types";

/** What stands for each particle: where it starts, and which one of those that start there it is. */
function names({ start }: Topology): string[] {
  const met = new Map<string, number>();
  return start.map((point) => {
    const at = point.join();
    const number = met.get(at) ?? 0;
    met.set(at, number + 1);
    return `${at} ${number}`;
  });
}

/** Follow the particles of groups and of the selection from now on; returns how to stop it. Those that come back, as
 * by Undo, are in their groups again. */
export function following(session: Session, options: Options): () => void {
  let before: Topology | null = null;
  const lost = new Map<string, Set<string>>();
  return effect(() => {
    const now = session.topology.value;
    const last = before;
    before = now ?? before;
    // as many as before: the same ones, which may start elsewhere
    if (!now || !last || now.particles === last.particles) return;
    const [groups, marked] = [options.groups.peek(), options.marked.peek()];
    if (!Object.keys(groups).length && !marked.length) return;
    const [old, current] = [names(last), names(now)];
    const places = new Map(current.map((name, i) => [name, i]));
    const moved = (set: number[], gone: Set<string>) => {
      const wanted = [...set.map((one) => old[one]!), ...gone];
      gone.clear();
      wanted.filter((name) => !places.has(name)).forEach((name) => gone.add(name));
      return wanted.flatMap((name) => places.get(name) ?? []);
    };
    const kept = Object.entries(groups).map(([called, set]) => {
      if (!lost.has(called)) lost.set(called, new Set());
      return [called, moved(set, lost.get(called)!)];
    });
    options.groups.value = Object.fromEntries(kept) as typeof groups;
    options.marked.value = moved(marked, new Set());
  });
}
