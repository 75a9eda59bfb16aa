// Labels on the canvas: names of anchors, groups and forces, or a number of each spring.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Point } from "../model";
import { endsOf } from "../view/sets";
import type { Tags } from "../view/types";
import { kinds } from "./catalogue";
import { titleOf } from "./forces";
import { shownFrame } from "./still";
import type { Studio } from "./studio";
import { said } from "./words";

const CHOICES: [Tags, string][] = [
  ["none", "None"],
  ["names", "Names"],
  ["forces", "Forces of springs"],
  ["lengths", "Lengths of springs"],
];
/** More labels than these are not read. */
const MOST = 120;
/** Labels nearer than this to one before are left out [CSS pixels]. */
const APART = 22;

interface Tag {
  text: string;
  at: Point;
  colour?: string | undefined;
}

export function TagsChoice({ studio: { options } }: { studio: Studio }) {
  return (
    <label class="field" title="Written on the canvas; of springs at most 120, the selected ones where some are">
      <span>Labels</span>
      <select
        aria-label="Labels"
        value={options.tags.value}
        onChange={(event) => (options.tags.value = event.currentTarget.value as Tags)}
      >
        {CHOICES.map(([name, seen]) => (
          <option key={name} value={name}>
            {seen}
          </option>
        ))}
      </select>
    </label>
  );
}

/** Over the canvas: the labels that have room. */
export function TagLabels({ studio }: { studio: Studio }) {
  const { session, options, view } = studio;
  void session.ticks.value;
  const turned = useSignal(0);
  const now = view.value;
  const isOn = options.tags.value !== "none";
  useEffect(() => (isOn ? now?.onMoved(() => (turned.value += 1)) : undefined), [now, isOn]);
  void turned.value;
  const canvas = document.querySelector(".drawing")?.getBoundingClientRect();
  if (!isOn || !now || !shownFrame(studio) || !canvas) return null;
  const tags = options.tags.value === "names" ? names(studio) : numbers(studio);
  const placed: { x: number; y: number; tag: Tag }[] = [];
  const section = options.section.value;
  const isCut = (at: Point) =>
    section !== null && at["xyz".indexOf(section.axis)]! > section.at !== section.isTurned;
  for (const tag of tags) {
    const seen = isCut(tag.at) ? null : now.spot(tag.at);
    if (!seen || placed.length >= MOST) continue;
    const x = seen.x - canvas.left;
    // names of the same place stand below each other
    const rows = options.tags.value === "names" ? [0, 16, 32, 48] : [0];
    const isFree = (y: number) =>
      placed.every((other) => Math.abs(other.y - y) > 14 || Math.abs(other.x - x) > APART + 3 * tag.text.length);
    const y = rows.map((row) => seen.y - canvas.top + row).find(isFree);
    if (y !== undefined) placed.push({ x, y, tag });
  }
  const written = placed.map(({ tag }) => tag.text).join(", ");
  return (
    <svg class="labels" role="img" aria-label={`Written beside the form: ${written}`}>
      {placed.map(({ x, y, tag }, i) => (
        <text key={i} x={x} y={y - 6} text-anchor="middle" style={tag.colour ? { fill: tag.colour } : {}}>
          {tag.text}
        </text>
      ))}
    </svg>
  );
}

/** Names in the middle of what they are of. */
function names(studio: Studio): Tag[] {
  const { session, options } = studio;
  const [topology, scene, frame] = [session.topology.value, session.scene.value, shownFrame(studio)];
  if (!topology || !scene || !frame) return [];
  const all: [string, number[], string?][] = [
    ...Object.entries(options.groups.value).map(([name, of]): [string, number[], string?] => [
      name,
      of,
      options.groupColours.value[name],
    ]),
    ...session.anchors.value
      .filter(({ name }) => name)
      .map(({ name, particles }): [string, number[]] => [name, particles]),
    ...scene.forces.map((force, i): [string, number[]] => [
      titleOf(force, kinds.value?.get(force.kind), i),
      [
        ...topology.springs.filter((_, spring) => topology.spring_forces[spring] === i).flat(),
        ...topology.loads.filter((load) => load.force === i).flatMap((load) => load.particles),
        ...(topology.meshes[String(force["mesh"] ?? "")]?.faces.flat() ?? []),
      ],
    ]),
  ];
  return all.flatMap(([text, particles, colour]) => {
    const found = particles.filter((particle) => particle < topology.particles);
    return found.length ? [{ text, at: middle(frame.positions, found), colour }] : [];
  });
}

/** A number of each spring, in its middle: of those that are picked or selected, else of all. */
function numbers(studio: Studio): Tag[] {
  const { session, options } = studio;
  const [topology, frame] = [session.topology.value, shownFrame(studio)];
  if (!topology || !frame) return [];
  const { picked, marked, tags } = options;
  const selected = new Set(marked.value);
  let chosen = topology.springs.flatMap((ends, i) => (ends.every((end) => selected.has(end)) ? [i] : []));
  if (picked.value?.kind === "spring") chosen = [picked.value.index];
  if (!chosen.length) chosen = topology.springs.map((_, i) => i).slice(0, 4 * MOST);
  return chosen.map((spring) => {
    const [a, b] = endsOf(topology.springs, [spring]).map((end) => middle(frame.positions, [end]));
    const length = a && b ? Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) : 0;
    const value = tags.value === "forces" ? frame.springForces[spring]! : length;
    return { text: said(value, 3), at: middle(frame.positions, topology.springs[spring]!) };
  });
}

function middle(positions: Float32Array, of: number[]): Point {
  const sum: Point = [0, 0, 0];
  for (const particle of of) {
    for (let axis = 0; axis < 3; axis++) sum[axis]! += positions[3 * particle + axis]! / of.length;
  }
  return sum;
}
