// The view in a saved model: read from the file where it is opened, taken up by the page of its session.
import { remember } from "./memory";
import type { Kept, Options } from "./types";

const taken = new Map<string, Kept>();
/** The part of a .hookean file that has how the model was looked at. */
export const VIEW = "view.json";
const LOCAL = 0x04034b50;
const MOST = 128;

/** What `view.json` of a .hookean file has; null if the file has none. */
export async function viewOf(file: File): Promise<unknown> {
  try {
    const part = await partOf(file, VIEW);
    return part && (JSON.parse(await part.text()) as unknown);
  } catch {
    return null; // the service reports what is wrong with a damaged file
  }
}

/** A part of a .hookean file, whose parts are not compressed; null if the file has none of this name. */
export async function partOf(file: File, wanted: string): Promise<Blob | null> {
  if (!file.name.toLowerCase().endsWith(".hookean")) return null;
  try {
    for (let at = 0, part = 0; part < MOST; part++) {
      const head = new DataView(await file.slice(at, at + 30).arrayBuffer());
      if (head.byteLength < 30 || head.getUint32(0, true) !== LOCAL) return null;
      const [size, named, more] = [head.getUint32(18, true), head.getUint16(26, true), head.getUint16(28, true)];
      const begin = at + 30 + named + more;
      const name = await file.slice(at + 30, at + 30 + named).text();
      if (name === wanted) return file.slice(begin, begin + size);
      at = begin + size;
    }
  } catch {
    // the service reports what is wrong with a damaged file
  }
  return null;
}

/** Keep a valid view for the page of a session. */
export function keepView(key: string, view: Kept): void {
  taken.set(key, view);
  if (view.eye) remember(key, view.eye);
}

/** Give the options of a session's page what was kept; returns it. */
export function takeUp(key: string, options: Options): Kept | null {
  const view = taken.get(key);
  if (!view) return null;
  taken.delete(key);
  // colours that a program gives come from the service
  if (view.colouring && view.colouring !== "given") options.colouring.value = view.colouring;
  if (view.scale) options.scale.value = { ...view.scale, low: view.scale.low ?? null, high: view.scale.high ?? null };
  if (view.picked) options.picked.value = view.picked;
  if (view.marked) options.marked.value = view.marked;
  if (view.groups) options.groups.value = view.groups;
  if (view.groupColours) options.groupColours.value = view.groupColours;
  options.layers.value = { ...options.layers.value, ...view.layers };
  return view;
}
