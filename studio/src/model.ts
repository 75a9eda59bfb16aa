// What the service sends about a session, as JSON has it. Arrays are lists.
import type { Status } from "./wire";

export type Point = [number, number, number];

export interface Units {
  length: string;
  force: string;
  time: string;
}

/** The file that keeps sessions and jobs. */
export interface Store {
  warnings: string[];
  repairs?: { when: string; copy: string; losses: { key: string; what: string }[] }[];
}

/** Status of a session. */
export interface Summary {
  key: string;
  label: string;
  revision: number;
  /** The revisions that last changed the anchors, and the rest of the scene; absent while it sleeps. */
  anchors_revision?: number;
  scene_revision?: number;
  iteration: number;
  /** [time] */
  time: number;
  /** [-] */
  residual: number;
  status: Status;
  /** One sentence on the status. */
  message: string;
  playing: boolean;
  /** Whether it plays to rest by its solver. */
  solving?: boolean;
  particles: number;
  /** Edits that can be undone, and made again. */
  undo: number;
  redo: number;
  awake: boolean;
  /** Sentences of the report. */
  warnings?: string[];
  /** In total [force length] */
  energy?: number | null;
  units?: Units;
}

/** What stays while a session runs. */
export interface Topology {
  particles: number;
  start: Point[];
  /** Particles at the two ends of each spring. */
  springs: [number, number][];
  /** The force of the scene that each spring belongs to, by its number. */
  spring_forces: number[];
  forces: { kind: string; name: string; role: string }[];
  /** Faces of three or four corners; a triangle repeats its last one. */
  meshes: Record<string, { faces: number[][] }>;
  geometry: { name: string; kind: string; particles: number[] | number[][]; faces?: number[][] }[];
  loads: { force: number; particles: number[]; vectors: Point[] }[];
  units: Units;
}

/** Particles that are held, as they are now. */
export interface Anchor {
  /** Place in the scene; -1 for one pinned while running. */
  number: number;
  name: string;
  particles: number[];
  /** [length] */
  targets: Point[];
  /** Of x, y and z, those that are held. */
  axes: string;
}

/** A scene as edits have left it: what the page reads of it. */
export interface Scene {
  forces: SceneForce[];
  settings: Record<string, number | string | boolean | null | Record<string, unknown>>;
  units: Units;
  /** What it was made from. */
  family?: { name: string; parameters: Parameters } | null;
  [field: string]: unknown;
}

export type Parameters = Record<string, number | string>;

export type SceneForce = { kind: string; name: string } & Record<string, unknown>;

/** Everything about the present shape. */
export interface Result {
  status: Status;
  message: string;
  particles: Point[];
  forces: ({ kind: string; name: string } & Record<string, unknown>)[];
  reactions: { particles: number[]; force: Point[]; names: string[]; exact: boolean[] };
  energy: Record<string, number>;
  /** [-] */
  residual: number;
  /** The largest force on a free particle that nothing balances [force]. */
  out_of_balance: number;
  stability: string;
  /** A sentence; "" for none. */
  stability_reason: string;
  /** The particle that moves most in the softest mode. */
  soft_particle: number | null;
  /** How far positions are from the equilibrium [length]; null where that is not known. */
  position_error: number | null;
  position_reason: string;
  report: { merged: number; unmatched: unknown[]; warnings: string[] };
  units: Units;
}

/** What is read off the surface of a shape. Numbers at particles are null where they are undefined. */
export interface SurfaceRead {
  /** From the start [length] */
  displacement: (number | null)[];
  /** [degrees] */
  slope: (number | null)[];
  /** [1/length] */
  mean_curvature: (number | null)[];
  /** [1/length^2] */
  gaussian_curvature: (number | null)[];
  /** Of cloth, per width [force/length] */
  stress: (number | null)[];
  /** Of cloth: 2 taut, 1 wrinkled, 0 slack */
  state: (number | null)[];
  /** Of cloth [-] */
  utilisation: (number | null)[];
  heights: { step: number; pieces: [Point, Point][]; heights: number[] };
  /** Ways of drops, and whether each stays on the surface. */
  water: { lines: Point[][]; stays: boolean[] };
}

/** An edit of a running session; all of it lands or nothing. */
export interface Patch {
  pin?: { particles: number[]; targets?: Point[]; axes?: string }[];
  release?: number[];
  move?: { anchor: number | string; targets?: Point[]; shift?: Point }[];
  forces?: Record<string, Record<string, unknown>>;
  settings?: Record<string, unknown>;
  /** Forces on particles of the session, by their numbers. */
  add?: SceneForce[];
  /** Forces to take away, by name or number. */
  remove?: (string | number)[];
  /** Alone: other parameters of the family that it was made from. */
  rebuild?: Parameters;
  /** Alone: what is drawn or deleted. */
  draw?: Draw;
  /** Alone: other units of the same numbers. */
  units?: Partial<Units>;
  /** Edits of one gesture are taken back as one. */
  gesture?: string;
}

/** What is drawn or deleted in one edit: one of these. Springs by number, faces by number or by their particles. */
export interface Draw {
  /** New particles, whose numbers follow the others, with faces and forces on old and new ones. */
  add?: { points?: Point[]; faces?: Record<string, number[][]>; forces?: SceneForce[] };
  divide?: { springs?: number[]; faces?: Record<string, number[]>; pieces?: number };
  extrude?: { edges: [number, number][]; by: Point; mesh?: string };
  delete?: { particles?: number[]; springs?: number[]; faces?: Record<string, number[]> };
}

/** What programs and pages share about a session beside its model. */
export interface Shared {
  picked: { kind: "particle" | "spring"; index: number } | null;
  /** Numbers that colour the springs, by springs or particles. */
  colours: { title: string; unit: string; of: "springs" | "particles"; values: number[] } | null;
}

export type Action = "play" | "relax" | "pause" | "step" | "reset" | "undo" | "redo";

/** A kind of force in the catalogue. */
export interface Kind {
  kind: string;
  title: string;
  summary: string;
  role: string;
  particles_per_element: number;
  /** Without a place it acts on all. */
  everywhere: boolean;
  fields: Field[];
}

/** A family of scenes to begin with. */
export interface Family {
  name: string;
  title: string;
  summary: string;
  parameters: Field[];
}

/** What a number may be; more_than and less_than are bounds it does not reach. */
export interface Bounds {
  minimum?: number;
  maximum?: number;
  more_than?: number;
  less_than?: number;
}

/** A column of a force, or a setting. */
export interface Field {
  name: string;
  description: string;
  /** In words: force, length, time; "-" for none. */
  unit: string;
  type: string;
  default: unknown;
  required?: boolean;
  bounds?: Bounds;
  choices?: string[];
  /** Of a vector, where they are not x, y and z. */
  components?: string[];
}

/** A figure of the gallery. */
export interface Example {
  id: string;
  figure: string;
  title: string;
  /** What it is and what to try. */
  sentence: string;
  picture: string;
}

/** What objects of a family (points, curves, surfaces) may become, with its values. */
export interface Role {
  role: string;
  family: string;
  summary: string;
  fields: Field[];
}

export type Values = Record<string, number | string>;

/** An object of a file; a role of null is that of its row. */
export interface Drawn {
  id: string;
  name: string;
  kind: string;
  role: string | null;
  values: Values;
  why?: string;
}

/** The objects of one family on one layer of a file. */
export interface Row {
  layer: string;
  family: string;
  kinds: string;
  roles: string[];
  role: string;
  values: Values;
  becomes: string[];
  objects: Drawn[];
}

/** What is on the layers of a file, a role for each, and the recipe of these roles. */
export interface Draft {
  name: string;
  said: string;
  size: string;
  unit: string;
  units: Units;
  weld_tolerance: number;
  rows: Row[];
  roles: Role[];
  recipe: unknown;
  fault: string;
  notes: string[];
  particles: number;
  held: number;
}

/** What somebody chose of a draft. */
export interface Choices {
  units: Units;
  values_in: Units;
  weld_tolerance: number | null;
  rows: { layer: string; family: string; role: string; values: Values }[];
  objects: { id: string; role: string; values: Values }[];
}
