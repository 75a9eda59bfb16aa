// Recordings and bookmarks in this browser: they stay until they or their session are deleted.
import type { Frame } from "../frame";
import type { Topology } from "../model";

export interface Reel {
  /** Of which form they are. */
  form: string;
  stride: number;
  shots: { at: number; frame: Frame }[];
  /** With the place of the eye as numbers; null for none. */
  bookmarks: { name: string; frame: Frame; place: number[] | null }[];
}

const STORE = "recordings";

const done = <T>(request: IDBRequest<T>): Promise<T> =>
  new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error ?? new Error("The browser keeps no recordings."));
  });

let opened: Promise<IDBDatabase> | null = null;

function open(): Promise<IDBDatabase> {
  opened ??= (() => {
    const request = indexedDB.open("hookean", 1);
    request.onupgradeneeded = () => request.result.createObjectStore(STORE);
    return done(request);
  })();
  return opened;
}

const table = async (mode: IDBTransactionMode) => (await open()).transaction(STORE, mode).objectStore(STORE);

/** Keep what was recorded of a session, or forget it; whether the browser has it. */
export async function keepReel(key: string, reel: Reel): Promise<boolean> {
  try {
    const into = await table("readwrite");
    const isAny = reel.shots.length > 0 || reel.bookmarks.length > 0;
    await (isAny ? done(into.put(reel, key)) : done(into.delete(key)));
    return true;
  } catch {
    return false; // private windows, or no room
  }
}

/** What was recorded of a session in this form; null for nothing. */
export async function keptReel(key: string, form: string): Promise<Reel | null> {
  try {
    const found = (await done((await table("readonly")).get(key))) as Reel | undefined;
    return found?.form === form ? found : null;
  } catch {
    return null;
  }
}

/** Forget what was recorded of sessions that there are not any more. */
export async function pruneReels(sessions: ReadonlySet<string>): Promise<void> {
  try {
    const into = await table("readwrite");
    const keys = await done(into.getAllKeys());
    for (const key of keys) if (!sessions.has(String(key))) into.delete(key);
  } catch {
    // nothing is kept then
  }
}

/** Stands for the particles, springs and faces of a form: frames are of one form. */
export function formOf({ particles, springs, meshes }: Topology): string {
  let hash = 17;
  const add = (number: number) => (hash = (Math.imul(hash, 31) + number) | 0);
  for (const [a, b] of springs) add(add(a) ^ b);
  for (const { faces } of Object.values(meshes)) for (const face of faces) face.forEach(add);
  return `${particles} ${springs.length} ${hash}`;
}
