import { CHANGES, header, type Header, MAGIC, POSITIONS, REACTIONS, SCALARS, SIZE, VERSION } from "./wire";
import { type Status, STATUSES } from "./wire";

/** A frame of a session: what moves. Its arrays are views of one, that of the message where it is whole. Those in which
 * nothing has changed since the frame before are that one's own. */
export interface Frame {
  number: number;
  /** Edits up to this one are in the frame. */
  revision: number;
  iteration: number;
  /** [time] */
  time: number;
  /** [-] */
  residual: number;
  /** Kinetic energy [force length]; 0 where the solver knows no time. */
  kinetic: number;
  status: Status;
  playing: boolean;
  /** x y z of each particle [length] */
  positions: Float32Array;
  /** The force in each spring of the topology, tension + [force] */
  springForces: Float32Array;
  /** x y z of the reaction on each held particle, in the order of their indices [force] */
  reactions: Float32Array;
}

/** The frame in a binary message, which may tell the changes to the one before; throws an Error if it is not of this
 * version. */
export function decode(data: ArrayBuffer, before: Frame | null = null): Frame {
  if (data.byteLength < SIZE) throw new Error("The service sent a frame that is shorter than its header.");
  const head = header(new DataView(data));
  const arrays = head.flags & CHANGES ? changed(head, data, before) : whole(head, data);
  const { number, revision, iteration, time, residual, kinetic } = head;
  return {
    number, revision, iteration, time, residual, kinetic,
    status: STATUSES[head.status]!,
    playing: head.playing === 1,
    ...arrays,
  };
}

type Arrays = Pick<Frame, "positions" | "springForces" | "reactions">;

const DIFFERS = "The service sent a frame whose length differs from its header.";

function whole(head: Header, data: ArrayBuffer): Arrays {
  check(head);
  const { particles, springs } = head;
  const rest = (data.byteLength - SIZE) / 4 - 3 * particles - springs;
  if (!(rest >= 0 && rest % 3 === 0 && rest > 0 === ((head.flags & REACTIONS) !== 0))) throw new Error(DIFFERS);
  const at = (first: number, count: number) => new Float32Array(data, SIZE + 4 * first, count);
  return {
    positions: at(0, 3 * particles),
    springForces: at(3 * particles, springs),
    reactions: at(3 * particles + springs, rest),
  };
}

function changed(head: Header, data: ArrayBuffer, before: Frame | null): Arrays {
  check(head);
  const count = (data.byteLength - SIZE) / 8;
  const { positions, springForces, reactions } = before ?? {};
  const fits = positions?.length === 3 * head.particles && springForces?.length === head.springs;
  if (!fits || !reactions || !Number.isInteger(count)) throw new Error(DIFFERS);
  const places = new Uint32Array(data, SIZE, count); // in their order
  const values = new Float32Array(data, SIZE + 4 * count, count);
  let done = 0;
  let first = 0;
  const next = (old: Float32Array): Float32Array => {
    const last = first + old.length;
    const made = done < count && places[done]! < last ? old.slice() : old;
    for (; done < count && places[done]! < last; done++) made[places[done]! - first] = values[done]!;
    first = last;
    return made;
  };
  return { positions: next(positions), springForces: next(springForces), reactions: next(reactions) };
}

function check(head: Header): void {
  if (head.magic !== MAGIC || head.version !== VERSION || head.size !== SIZE) {
    throw new Error(`The service sends frames of version ${head.version}, this page needs ${VERSION}: reload it.`);
  }
  const isKnown = (head.flags & ~(POSITIONS | SCALARS | REACTIONS | CHANGES)) === 0;
  if (!isKnown || head.status >= STATUSES.length) throw new Error(DIFFERS);
}
