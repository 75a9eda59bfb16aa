// At the hand while it drags: where the particle is, how far it was taken, and the force that this takes.
import type { Point } from "../model";
import type { Dragged } from "../view/types";
import { reactionOn } from "./picked";
import type { Studio } from "./studio";
import { measured, said } from "./words";

const ROOM = 190; // CSS pixels beside the particle, or it is written on the other side

export function Readout({ studio }: { studio: Studio }) {
  const dragged = studio.view.value?.dragged.value;
  return dragged ? <Beside studio={studio} dragged={dragged} /> : null;
}

function Beside({ studio: { session, view }, dragged }: { studio: Studio; dragged: Dragged }) {
  void session.ticks.value;
  const { particle, from } = dragged;
  const { frame } = session;
  const { length = "", force = "" } = session.topology.value?.units ?? {};
  const seen = view.value?.project(particle);
  const canvas = document.querySelector(".drawing")?.getBoundingClientRect();
  if (!frame || !seen || !canvas) return null;
  const at = [0, 1, 2].map((axis) => frame.positions[3 * particle + axis]!) as Point;
  const pull = reactionOn(session.anchors.value, frame.reactions, particle);
  const [x, y] = [seen.x - canvas.left, seen.y - canvas.top];
  const side = x + ROOM > canvas.width ? { right: `${canvas.width - x + 18}px` } : { left: `${x + 18}px` };
  return (
    <div class="readout numbers" role="group" aria-label="At the hand" style={{ ...side, top: `${y + 14}px` }}>
      <p>
        {at.map((coordinate) => said(coordinate)).join(", ")} {length}
      </p>
      <p>Moved {measured(Math.hypot(at[0] - from[0], at[1] - from[1], at[2] - from[2]), length)}</p>
      {pull && <p>Reaction {measured(Math.hypot(...pull), force)}</p>}
    </div>
  );
}
