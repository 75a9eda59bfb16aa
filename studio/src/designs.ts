// Design problems over HTTP: a job of the service that is watched by its events and can be cancelled.
import { type Refused, ask, read, refusal, send } from "./api";
import type { Point, Scene } from "./model";

/** What may vary: a column of a force, or where an anchor holds its particles. */
export interface Variable {
  name: string;
  force?: string | number;
  field?: string;
  anchor?: string | number;
  axes?: string;
  tie: "each" | "all" | number[][];
  lower?: number;
  upper?: number;
}

/** A quantity with its aim or its limits; the rest are fields of its kind. */
export interface Measured {
  kind: string;
  name: string;
  target?: number | number[];
  lower?: number;
  upper?: number;
  weight?: number;
  [field: string]: unknown;
}

export interface Problem {
  scene: Scene;
  variables: Variable[];
  goals: Measured[];
  constraints: Measured[];
  start?: number[];
}

export type Numbers = number | number[] | number[][];

/** The best values found, and how they stand to goals, constraints and bounds. */
export interface Answer {
  status: string;
  message: string;
  objective: number;
  iterations: number;
  variables: {
    name: string;
    value: Numbers;
    unit: string;
    at_bound: boolean | boolean[] | boolean[][];
    gain: Numbers | null;
  }[];
  goals: {
    name: string;
    kind: string;
    value: Numbers;
    target: Numbers | null;
    met: boolean | null;
    unit: string;
    conflicts: string[];
  }[];
  constraints: { name: string; kind: string; value: Numbers; met: boolean; unit: string }[];
  warnings: string[];
  result: { particles: Point[] };
  scene: Scene;
}

export interface Job {
  id: string;
  status: "waiting" | "running" | "cancelling" | "done" | "failed" | "cancelled";
  message: string;
}

/** Equilibria so far, and the least objective. */
export interface Progress {
  iteration: number;
  objective: number;
}

const at = (id: string) => `/v1/jobs/${encodeURIComponent(id)}`;

/** Begin a search. */
export const design = (problem: Problem) => send<Job>("POST", "/v1/design", problem);

/** Ask a search to end; its best values so far can be read afterwards. */
export const cancel = (id: string) => ask(at(id), { method: "DELETE" });

/** Values of goals at the equilibrium of a scene. */
export const measure = (scene: Scene, variables: Variable[], goals: Measured[]) =>
  send<{ values: number[][] }>("POST", "/v1/sensitivity", { scene, variables, goals });

/** What a search that has ended found; null where it was stopped before it found anything. */
export async function found(id: string): Promise<Answer | null> {
  const { rows } = await read<{ rows: unknown[] }>(`${at(id)}/results?format=json`);
  if (!rows.length) return null;
  const answer = await read<Answer | { message: string }>(`${at(id)}/results/0`);
  if ("variables" in answer) return answer;
  throw refusal(422, { detail: answer.message });
}

/** Follow a search to its end: the job as it stands then. */
export function follow(id: string, progress: (now: Progress) => void): Promise<Job> {
  const events = new EventSource(`${at(id)}/events`);
  return new Promise<Job>((resolve, reject: (error: Refused) => void) => {
    events.addEventListener("progress", (event) => progress(JSON.parse(event.data as string) as Progress));
    for (const end of ["done", "failed", "cancelled"])
      events.addEventListener(end, (event) => resolve(JSON.parse((event as MessageEvent<string>).data) as Job));
    // it connects again by itself, unless the service answered with a refusal
    events.onerror = () =>
      events.readyState === EventSource.CLOSED &&
      reject(refusal(0, { detail: "The search is lost: the service does not know it any more. Search again." }));
  }).finally(() => events.close());
}
