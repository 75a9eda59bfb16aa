// What the view shows and receives: signals that panels set and the view follows, and what it gives back.
import { type Signal, signal } from "@preact/signals";
import type { Frame } from "../frame";
import type { PerspectiveCamera } from "three";
import type { Point } from "../model";
import type { Acting } from "./acting";
import type { Place } from "./camera";
import type { Dress } from "./picture";

export type Colouring = "force" | "strain" | "plain" | "given";
export type Lock = "view" | "x" | "y" | "z" | "xy" | "xz" | "yz";
export type Look = "perspective" | "top" | "front" | "right";
export type Layer = "mesh" | "springs" | "particles" | "anchors" | "loads" | "reactions" | "floor" | "guides";

/** What is picked. */
export type Picked = { kind: "particle" | "spring"; index: number } | null;

/** What a drag on the canvas does: as ever, or select particles; or a click draws. */
export type Tool = "none" | "box" | "lasso" | "draw";

/** What clicks, boxes and lassos select. */
export type Element = "particles" | "faces";

/** Particles by the name of a group. */
export type Groups = Record<string, number[]>;

/** How numbers become colours: from extreme to extreme, about 0, or by the logarithm of their size. */
export type ScaleKind = "auto" | "even" | "log";

/** With its two ends; null: as found. */
export interface Scale {
  kind: ScaleKind;
  low: number | null;
  high: number | null;
}

/** Numbers that a program gave to colour the springs with, one each. */
export interface Given {
  title: string;
  unit: string;
  values: Float32Array;
}

/** The lines of a variant, or of the best values of a design: its name in the legend, x y z of its particles [length],
 * and pairs of these. */
export interface Shadow {
  name: string;
  positions: Float32Array;
  ends: Int32Array;
}

/** Lines on the surface: of equal height, or ways of water that runs off or stays. */
export interface Sketch {
  kind: "height" | "runs" | "stays";
  /** x y z of their points [length], and pairs of these. */
  positions: Float32Array;
  ends: Int32Array;
}

/** What is read off the surface: colours of its faces by numbers at their particles, NaN for none, and lines. */
export interface Painted {
  colours: { title: string; unit: string; values: Float32Array } | null;
  lines: Sketch[];
}

/** A shape that is shown in the place of the present one, and what it is, in a sentence. */
export interface Still {
  frame: Frame;
  said: string;
  /** What acts on it, where that is not what acts now. */
  loads?: Acting;
}

/** Which number a colour stands for. */
export interface Legend {
  /** Force or strain. */
  title: string;
  /** As written beside the numbers; "-" for none. */
  unit: string;
  low: number;
  high: number;
  /** How many values lie beyond the ends; they have the colours of the ends. */
  beyond: number;
  /** The value that all have, where they have one. */
  equal: number | null;
  /** CSS colours from low to high, evenly spaced. */
  colours: string[];
}

/** What a person has chosen to see: of this page alone, the session knows nothing of it. */
export interface Options {
  colouring: Signal<Colouring>;
  scale: Signal<Scale>;
  layers: Signal<Record<Layer, boolean>>;
  /** Along what a drag goes: the plane that faces the eye, an axis, a plane. */
  lock: Signal<Lock>;
  picked: Signal<Picked>;
  tool: Signal<Tool>;
  groups: Signal<Groups>;
  /** Particles that are selected, or that a warning speaks of. */
  marked: Signal<number[]>;
  element: Signal<Element>;
  /** Selected faces, by their particles, in the order of their selection. */
  markedFaces: Signal<number[][]>;
  /** Particles between which is measured, in their order. */
  measured: Signal<number[]>;
  /** Whether the numbers of those that are selected are shown. */
  numbers: Signal<boolean>;
  /** Rest length of each spring [length], for strain; null: not known yet. */
  restLengths: Signal<Float32Array | null>;
  /** What faces and lines bear, as it was at rest; null: not known of these loads. */
  spread: Signal<Acting | null>;
  given: Signal<Given | null>;
  /** A variant that is drawn over the form. */
  ghost: Signal<Shadow | null>;
  /** What is shown on the surface. */
  painted: Signal<Painted | null>;
  /** A moment of a recording, or a load case; null: the present shape. */
  still: Signal<Still | null>;
  /** CSS colours of groups, by their names. */
  groupColours: Signal<Record<string, string>>;
  /** The plane in which corners are drawn; null: not shown. */
  working: Signal<Sheet | null>;
  /** What is written beside the form. */
  tags: Signal<Tags>;
  /** A plane beyond which nothing of the form is shown. */
  section: Signal<Section | null>;
  dark: Signal<boolean>;
}

/** Nothing; names of anchors, groups and forces; or numbers of springs. */
export type Tags = "none" | "names" | "forces" | "lengths";

/** The plane across an axis at a coordinate [length], with a grid of this step. */
export interface Sheet {
  axis: "x" | "y" | "z";
  at: number;
  step: number;
}

/** The plane across an axis at a coordinate [length]; shown is what is below, or above if `isTurned`. */
export interface Section {
  axis: "x" | "y" | "z";
  at: number;
  isTurned: boolean;
}

export const options = (): Options => ({
  colouring: signal<Colouring>("force"),
  layers: signal({
    mesh: true,
    springs: true,
    particles: true,
    anchors: true,
    loads: true,
    reactions: true,
    floor: true,
    guides: true,
  }),
  scale: signal<Scale>({ kind: "auto", low: null, high: null }),
  lock: signal<Lock>("view"),
  picked: signal<Picked>(null),
  tool: signal<Tool>("none"),
  groups: signal<Groups>({}),
  marked: signal<number[]>([]),
  element: signal<Element>("particles"),
  markedFaces: signal<number[][]>([]),
  measured: signal<number[]>([]),
  numbers: signal(false),
  restLengths: signal<Float32Array | null>(null),
  spread: signal<Acting | null>(null),
  given: signal<Given | null>(null),
  ghost: signal<Shadow | null>(null),
  painted: signal<Painted | null>(null),
  still: signal<Still | null>(null),
  groupColours: signal<Record<string, string>>({}),
  working: signal<Sheet | null>(null),
  tags: signal<Tags>("none"),
  section: signal<Section | null>(null),
  dark: signal(false),
});

/** How a model was looked at, in its file. */
export interface Kept {
  /** Target and direction to the eye (x y z each), height seen [length], angle [degrees]. */
  eye?: number[];
  colouring?: Colouring;
  scale?: Scale;
  groups?: Groups;
  groupColours?: Record<string, string>;
  /** How the file that it was made from was read, and what that is called. */
  recipe?: { file: string; text: string };
  layers?: Partial<Record<Layer, boolean>>;
  /** A design problem of it. */
  design?: unknown;
  /** What was picked and selected, and what was read off the surface. */
  picked?: Picked;
  marked?: number[];
  surface?: unknown;
}

/** A particle in the hand, and where it was taken from [length]. */
export interface Dragged {
  particle: number;
  from: Point;
}

export interface View {
  readonly dragged: Signal<Dragged | null>;
  readonly legend: Signal<Legend | null>;
  /** The scale of coloured faces. */
  readonly faces: Signal<Legend | null>;
  /** The longest arrows of loads and of reactions [force]; 0 for none. */
  readonly arrows: Signal<{ load: number; reaction: number }>;
  /** What the keyboard has just done, in a sentence, to be read out. */
  readonly announcement: Signal<string>;
  /** Whether the form has left the view. */
  readonly away: Signal<boolean>;
  /** Frames drawn in the last second. */
  readonly rate: Signal<number>;
  /** All of the form into view. */
  fit(): void;
  look(from: Look): void;
  /** Bring particles into view. */
  show(particles: number[]): void;
  /** Particles drawn inside of a closed line on the canvas [CSS pixels]. */
  inside(line: { x: number; y: number }[]): number[];
  /** Faces whose middles are drawn inside of it. */
  facesInside(line: { x: number; y: number }[]): number[][];
  /** Particles of the springs whose values lie beyond the scale. */
  beyond(): number[];
  /** Particles of faces whose values lie beyond their scale. */
  facesBeyond(): number[];
  /** Draw now, in full quality: the canvas can be read until this task ends. */
  render(): void;
  /** How it is looked at now: what a saved model keeps. */
  kept(): Kept;
  /** From where it is looked at. */
  place(): Place;
  put(place: Place): void;
  /** Called when that changes; returns how to stop it. */
  onMoved(watcher: () => void): () => void;
  /** Colours, layers and sizes as they are drawn. */
  dressing(): Dress;
  /** What is seen now, in full quality. */
  png(): Promise<Blob>;
  readonly camera: PerspectiveCamera;
  /** Where a particle is drawn [CSS pixels of the page]; null behind the eye. */
  project(particle: number): { x: number; y: number } | null;
  /** Where a point is drawn [CSS pixels of the page]; null behind the eye. */
  spot(point: ArrayLike<number>): { x: number; y: number } | null;
  /** What is drawn: x y z of each particle [length]. */
  particles(): Float32Array;
  dispose(): void;
}
