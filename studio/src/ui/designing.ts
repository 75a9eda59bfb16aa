// A design problem of a session: what may vary, goals, constraints, and the search that follows them. The problem is
// kept by this browser; the search is a job of the service, and one runs at a time: the newest problem replaces others.
import { effect, signal } from "@preact/signals";
import { type Answer, type Measured, type Problem, type Variable, cancel, design, follow, found } from "../designs";
import { gesture } from "../hand";
import type { Patch, Scene } from "../model";
import type { Session } from "../session";
import { remember, remembered } from "./theme";

/** What a goal asks for: a target, a range, or as little as possible. */
export type Aim = "target" | "range" | "least";

export interface Goal extends Measured {
  aim: Aim;
  /** In words, as the schema has it. */
  unit: string;
  /** At the equilibrium of the scene when it was added. */
  values: number[];
}

export interface Limit extends Measured {
  unit: string;
  values: number[];
}

export interface Kept {
  variables: Variable[];
  goals: Goal[];
  constraints: Limit[];
}

/** How the search stands. */
export interface Search {
  stage: "none" | "searching" | "ended" | "stopped" | "failed";
  /** Equilibria so far, and the least objective; null until the first. */
  iterations: number;
  objective: number | null;
  /** Why it failed; "" for nothing. */
  fault: string;
}

const NONE: Search = { stage: "none", iterations: 0, objective: null, fault: "" };
/** So long a search may go on when the problem has changed: a shorter one ends in its own time [ms]. */
const PATIENCE = 700;
/** Ends from whose values no search goes on well. */
const NOWHERE = ["stalled", "unbounded"];

const kept = (key: string) => `hookean-design-${key}`;

export class Designing {
  readonly problem;
  readonly search = signal<Search>(NONE);
  /** The last that was found; null for nothing. */
  readonly answer = signal<Answer | null>(null);
  /** The problem that the answer is of. */
  readonly answered = signal("");
  private readonly forget: () => void;
  private next: Problem | null = null;
  private running: Promise<void> | null = null;
  private job = "";
  private began = 0;
  private timer = 0;
  private stopped = false;
  private closed = false;

  constructor(private readonly session: Session) {
    this.problem = signal<Kept>(remembered<Kept>(kept(session.key), { variables: [], goals: [], constraints: [] }));
    this.forget = effect(() => {
      if (isAny(this.problem.value)) remember(kept(session.key), this.problem.value);
      else localStorage.removeItem(kept(session.key));
    });
  }

  /** End with its page: a search that runs is cancelled. */
  dispose(): void {
    this.closed = true;
    this.forget();
    this.stop();
  }

  /** Whether there is something to search for. */
  get isWhole(): boolean {
    const { variables, goals, constraints } = this.problem.value;
    return variables.length > 0 && goals.length + constraints.length > 0;
  }

  /** Whether the answer is of the problem as it is now. */
  get isCurrent(): boolean {
    return this.answered.value === JSON.stringify(asked(this.problem.value));
  }

  /** Change the problem; with an answer on the screen, or a search under way, the search follows. */
  change(part: Partial<Kept>): void {
    this.problem.value = { ...this.problem.value, ...part };
    if (this.isWhole && this.search.value.stage !== "none" && this.search.value.stage !== "stopped") this.start();
  }

  /** Search the present problem in the scene as it is now, from the best values so far. */
  start(): void {
    const scene = this.session.scene.value;
    if (!scene || !this.isWhole) return;
    this.stopped = false;
    this.next = { scene, ...asked(this.problem.value) };
    if (!this.running) this.running = this.run().finally(() => (this.running = null));
    else this.hurry();
  }

  /** Stop the search; the best so far stays. */
  stop(): void {
    this.stopped = true;
    this.next = null;
    this.drop();
  }

  /** The edit that gives the model the values found. */
  values(): Patch {
    const [answer, scene] = [this.answer.value, this.session.scene.value];
    const patch: Patch = { gesture: gesture("design") };
    if (!answer || !scene) return patch;
    for (const { force, field, anchor } of this.problem.value.variables) {
      if (field !== undefined && force !== undefined) {
        const number = numberOf(scene.forces, force);
        ((patch.forces ??= {})[String(number)] ??= {})[field] = answer.scene.forces[number]?.[field];
      } else if (anchor !== undefined) {
        const number = numberOf(anchorsOf(scene), anchor);
        const { targets } = anchorsOf(answer.scene)[number] ?? {};
        if (targets && !patch.move?.some((one) => one.anchor === number))
          (patch.move ??= []).push({ anchor: number, targets });
      }
    }
    return patch;
  }

  private hurry(): void {
    clearTimeout(this.timer);
    const left = this.began + PATIENCE - performance.now();
    this.timer = window.setTimeout(() => this.next && this.drop(), Math.max(0, left));
  }

  /** Cancel the job that runs. */
  private drop(): void {
    if (this.job) void cancel(this.job).catch(() => undefined); // its events show what became of it
  }

  private async run(): Promise<void> {
    while (this.next && !this.closed) {
      const problem = this.next;
      this.next = null;
      this.search.value = { ...NONE, stage: "searching" };
      try {
        const ended = await this.one(problem);
        if (!this.next) this.search.value = { ...this.search.value, stage: ended ? "ended" : "stopped" };
      } catch (error) {
        const fault = error instanceof Error ? error.message : String(error);
        if (!this.next) this.search.value = { ...NONE, stage: "failed", fault };
      }
    }
  }

  /** One search to its end; whether it came to its own end. */
  private async one(problem: Problem): Promise<boolean> {
    const { scene, ...rest } = problem;
    const started = this.begin(problem);
    this.began = performance.now();
    const { id } = await design(started ? { ...problem, start: started } : problem);
    this.job = id;
    if (this.stopped) this.drop();
    else if (this.next) this.hurry();
    const job = await follow(id, ({ iteration, objective }) => {
      this.search.value = { ...this.search.value, iterations: iteration, objective };
    }).finally(() => (this.job = ""));
    if (job.status === "failed") throw new Error(job.message);
    const answer = await found(id);
    if (answer && !this.closed) {
      this.answer.value = answer;
      this.answered.value = JSON.stringify(rest);
      this.of = unknowns(problem);
    }
    return job.status === "done";
  }

  /** The problem whose unknowns the answer has. */
  private of = "";

  /** Values to begin with: the best so far, where the same may vary in the same scene. */
  private begin(problem: Problem): number[] | null {
    const answer = this.answer.peek();
    if (!answer || NOWHERE.includes(answer.status) || this.of !== unknowns(problem)) return null;
    return answer.variables.flatMap(({ value }) => [value].flat(2));
  }
}

/** Whether there is anything in a problem. */
export const isAny = ({ variables, goals, constraints }: Kept) =>
  variables.length + goals.length + constraints.length > 0;

/** Whether this browser keeps a problem of a session. */
export const isKept = (key: string) => remembered<unknown>(kept(key), null) !== null;

/** Whether a value from a file is a problem. */
export function isProblem(told: unknown): boolean {
  const { variables, goals, constraints } = (told ?? {}) as Partial<Kept>;
  return [variables, goals, constraints].every(
    (part) => Array.isArray(part) && part.every((one) => typeof one === "object" && one !== null),
  );
}

/** Give the page of a session the problem that a file kept. */
export function keepDesign(key: string, design: unknown): void {
  if (isProblem(design)) remember(kept(key), design);
}

const unknowns = ({ scene, variables }: Problem) =>
  JSON.stringify([variables, scene.forces.map(({ kind, name }) => [kind, name]), anchorsOf(scene)]);

/** The problem as the service takes it: without what only the page knows. */
function asked({ variables, goals, constraints }: Kept): Omit<Problem, "scene" | "start"> {
  return {
    variables,
    goals: goals.map(({ aim, unit: _, values: __, target, lower, upper, ...goal }) => ({
      ...goal,
      ...(aim === "target" && target !== undefined && { target }),
      ...(aim === "range" && lower !== undefined && { lower }),
      ...(aim === "range" && upper !== undefined && { upper }),
    })),
    constraints: constraints.map(({ unit: _, values: __, ...limit }) => limit),
  };
}

export interface Held {
  name: string;
  axes: string;
  particles: number[] | null;
  targets: [number, number, number][] | null;
}

export const anchorsOf = (scene: Scene) => (scene["anchors"] ?? []) as Held[];

/** How a part of the scene is named in a problem: by its name, which stays, where no other has it; or its number. */
export function nameOf(parts: { name: string }[], number: number): string | number {
  const { name } = parts[number]!;
  return name && parts.filter((other) => other.name === name).length === 1 ? name : number;
}

export const numberOf = (parts: { name: string }[], named: string | number) =>
  typeof named === "number" ? named : parts.findIndex(({ name }) => name === named);
