import { header, type Header, MAGIC, POSITIONS, REACTIONS, SCALARS, SIZE, VERSION } from "./wire";
import { type Status, STATUSES } from "./wire";

/** A frame of a session: what moves. Its arrays are views of the message: nothing is copied. */
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

/** The frame in a binary message; throws an Error if it is not of this version. */
export function decode(data: ArrayBuffer): Frame {
  if (data.byteLength < SIZE) throw new Error("The service sent a frame that is shorter than its header.");
  const head = header(new DataView(data));
  const rest = check(head, data.byteLength);
  const at = (first: number, count: number) => new Float32Array(data, SIZE + 4 * first, count);
  const { number, revision, iteration, time, residual, kinetic, particles, springs } = head;
  return {
    number, revision, iteration, time, residual, kinetic,
    status: STATUSES[head.status]!,
    playing: head.playing === 1,
    positions: at(0, 3 * particles),
    springForces: at(3 * particles, springs),
    reactions: at(3 * particles + springs, rest),
  };
}

/** How many numbers are left for the reactions. */
function check(head: Header, length: number): number {
  if (head.magic !== MAGIC || head.version !== VERSION || head.size !== SIZE) {
    throw new Error(`The service sends frames of version ${head.version}, this page needs ${VERSION}: reload it.`);
  }
  const rest = (length - SIZE) / 4 - 3 * head.particles - head.springs;
  const known = (head.flags & ~(POSITIONS | SCALARS | REACTIONS)) === 0 && head.status < STATUSES.length;
  const whole = rest >= 0 && rest % 3 === 0 && rest > 0 === ((head.flags & REACTIONS) !== 0);
  if (!known || !whole) throw new Error("The service sent a frame whose length differs from its header.");
  return rest;
}
