// For tests and scripts in the page: what is drawn, as numbers.
import type { Session } from "./session";
import { stats, type Stats } from "./stats";
import type { View } from "./view/types";

export interface Hookean {
  /** Of the session that is shown. */
  key: string;
  stats: Stats;
  /** Where a particle is drawn [CSS pixels of the page]; null behind the eye. */
  project: View["project"];
  /** Where a point is drawn [CSS pixels of the page]; null behind the eye. */
  spot: View["spot"];
  /** What is drawn: x y z of each particle [length]. */
  particles: View["particles"];
}

declare global {
  interface Window {
    hookean?: Hookean;
  }
}

/** Put it at `window.hookean`; returns how to take it away. */
export function expose(session: Session, view: View): () => void {
  const made: Hookean = {
    key: session.key,
    stats,
    project: (particle) => view.project(particle),
    spot: (point) => view.spot(point),
    particles: () => view.particles(),
  };
  window.hookean = made;
  return () => {
    if (window.hookean === made) delete window.hookean;
  };
}
