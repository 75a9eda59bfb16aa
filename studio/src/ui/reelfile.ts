// What this page adds to a .hookean file: how the model is looked at, and recordings and bookmarks in a part that this
// page alone writes and reads. That is the length of a head, the head as JSON, and the numbers of its frames one after
// the other.
import type { Frame } from "../frame";
import { partOf, VIEW } from "../view/kept";
import type { Kept } from "../view/types";
import type { Reel } from "./reel";

const PART = "recording.bin";
const ARRAYS = ["positions", "springForces", "reactions"] as const;
const LITTLE = true;

interface Told {
  /** Seconds of a shot; the name and eye of a bookmark. */
  at?: number;
  name?: string;
  place?: number[] | null;
  frame: Omit<Frame, (typeof ARRAYS)[number]>;
  /** Of each of the arrays. */
  lengths: number[];
}

type Head = Pick<Reel, "form" | "stride"> & { shots: Told[]; bookmarks: Told[] };

function toldOf(frame: Frame): Pick<Told, "frame" | "lengths"> {
  const { positions, springForces, reactions, ...rest } = frame;
  return { frame: rest, lengths: [positions.length, springForces.length, reactions.length] };
}

function written({ form, stride, shots, bookmarks }: Reel): Uint8Array {
  const head: Head = {
    form,
    stride,
    shots: shots.map(({ at, frame }) => ({ at, ...toldOf(frame) })),
    bookmarks: bookmarks.map(({ name, place, frame }) => ({ name, place, ...toldOf(frame) })),
  };
  const text = JSON.stringify(head);
  const bytes = new TextEncoder().encode(text);
  const first = 4 + Math.ceil(bytes.length / 4) * 4;
  const arrays = [...shots, ...bookmarks].flatMap(({ frame }) => ARRAYS.map((name) => frame[name]));
  const made = new Uint8Array(first + 4 * arrays.reduce((sum, { length }) => sum + length, 0));
  new DataView(made.buffer).setUint32(0, bytes.length, LITTLE);
  made.set(bytes, 4);
  const numbers = new Float32Array(made.buffer, first);
  let at = 0;
  for (const array of arrays) {
    numbers.set(array, at);
    at += array.length;
  }
  return made;
}

/** Throws an Error where the part is damaged. */
function read(data: ArrayBuffer): Reel {
  const size = new DataView(data).getUint32(0, LITTLE);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, size))) as Head;
  let at = 4 + Math.ceil(size / 4) * 4;
  const frameOf = ({ frame, lengths }: Told): Frame => {
    const [positions, springForces, reactions] = lengths.map((length) => {
      const array = new Float32Array(data, at, length);
      at += array.byteLength;
      return array;
    });
    return { ...frame, positions: positions!, springForces: springForces!, reactions: reactions! };
  };
  return {
    form: String(head.form),
    stride: Math.max(1, Number(head.stride) || 1),
    shots: head.shots.map((one) => ({ at: Number(one.at), frame: frameOf(one) })),
    bookmarks: head.bookmarks.map((one) => ({ name: String(one.name), place: one.place ?? null, frame: frameOf(one) })),
  };
}

/** The file of a model with how it is looked at, and with what was recorded of it. */
export async function completed(file: Blob, view: Kept | null, reel: Reel | null): Promise<Blob> {
  if (!view && !reel) return file;
  const seen = view && new TextEncoder().encode(JSON.stringify(view));
  const more = { ...(seen && { [VIEW]: seen }), ...(reel && { [PART]: written(reel) }) };
  return changed(file, (parts) => ({ ...parts, ...more }));
}

/** What was recorded in a file, and the file without it, as the service needs it. */
export async function reelOf(file: File): Promise<{ reel: Reel | null; model: File }> {
  const data = await partOf(file, PART);
  if (!data) return { reel: null, model: file };
  const model = await changed(file, ({ [PART]: _, ...parts }) => parts);
  try {
    return { reel: read(await data.arrayBuffer()), model: new File([model], file.name) };
  } catch {
    return { reel: null, model: new File([model], file.name) }; // the model is whole
  }
}

type Parts = Record<string, Uint8Array>;

/** An archive with other parts, in their order. */
async function changed(file: Blob, made: (parts: Parts) => Parts): Promise<Blob> {
  const { unzipSync, zipSync } = await import("three/examples/jsm/libs/fflate.module.js");
  const parts = unzipSync(new Uint8Array(await file.arrayBuffer())) as Parts;
  const archive = zipSync(made(parts), { level: 0, mtime: new Date(1980, 0, 2) }) as Uint8Array<ArrayBuffer>;
  return new Blob([archive], { type: file.type });
}
