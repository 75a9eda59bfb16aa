// Written by hookean_server.sessions.wire_typescript from wire.py.
export const MAGIC = "HKFR";
export const VERSION = 1;
export const SIZE = 64;
export const POSITIONS = 1;
export const SCALARS = 2;
export const REACTIONS = 4;
export const CHANGES = 8;
export const STATUSES = [
  "running",
  "converged",
  "stalled",
  "diverged",
  "max_iterations",
  "time_limit",
  "cancelled",
] as const;

export type Status = (typeof STATUSES)[number];

/** The first bytes of a frame, as numbers. */
export interface Header {
  magic: string;
  version: number;
  size: number;
  flags: number;
  number: number;
  revision: number;
  iteration: number;
  time: number;
  residual: number;
  particles: number;
  springs: number;
  status: number;
  playing: number;
  zero: number;
  kinetic: number;
}

/** The header of the frame in `view`, which holds at least SIZE bytes. */
export function header(view: DataView): Header {
  return {
    magic: String.fromCharCode(...new Uint8Array(view.buffer, view.byteOffset + 0, 4)),
    version: view.getUint16(4, true),
    size: view.getUint16(6, true),
    flags: view.getUint32(8, true),
    number: view.getUint32(12, true),
    revision: Number(view.getBigUint64(16, true)),
    iteration: Number(view.getBigUint64(24, true)),
    time: view.getFloat64(32, true),
    residual: view.getFloat64(40, true),
    particles: view.getUint32(48, true),
    springs: view.getUint32(52, true),
    status: view.getUint8(56),
    playing: view.getUint8(57),
    zero: view.getUint16(58, true),
    kinetic: view.getFloat32(60, true),
  };
}
