// Scenes to begin with, from a few parameters: a cable, a net on a grid between corners of two heights, a radial net.
import type { Point } from "../model";

export interface Parameter {
  name: string;
  seen: string;
  value: number;
  /** In words, as the catalogue has it; "" for a count. */
  unit: string;
  minimum: number;
  maximum: number;
  whole?: boolean;
}

export interface Beginning {
  name: string;
  hint: string;
  parameters: Parameter[];
  make: (values: Record<string, number>) => Shape;
}

interface Shape {
  particles: Point[];
  pairs: [number, number][];
  faces: number[][];
  held: number[];
}

const length = (name: string, seen: string, value: number, minimum = 1e-3): Parameter => ({
  name,
  seen,
  value,
  unit: "length",
  minimum,
  maximum: 1e6,
});
const count = (name: string, seen: string, value: number, minimum: number): Parameter => ({
  name,
  seen,
  value,
  unit: "",
  minimum,
  maximum: 200,
  whole: true,
});

export const BEGINNINGS: Beginning[] = [
  {
    name: "Cable",
    hint: "Springs in a row, held at both ends",
    parameters: [length("span", "Span", 10), count("parts", "Springs", 20, 1)],
    make: ({ span, parts }) => ({
      particles: Array.from({ length: parts! + 1 }, (_, i): Point => [(span! * i) / parts!, 0, 0]),
      pairs: Array.from({ length: parts! }, (_, i): [number, number] => [i, i + 1]),
      faces: [],
      held: [0, parts!],
    }),
  },
  {
    name: "Grid",
    hint: "A net held at its corners; a rise of two opposite corners makes it a saddle (hypar)",
    parameters: [
      length("width", "Width", 10),
      length("depth", "Depth", 10),
      length("rise", "Rise", 3, -1e6),
      count("across", "Faces across", 10, 1),
      count("along", "Faces along", 10, 1),
    ],
    make: ({ width, depth, rise, across, along }) => grid(width!, depth!, rise!, across!, along!),
  },
  {
    name: "Radial net",
    hint: "Rings and rays about a middle, held at the outer ring",
    parameters: [length("radius", "Radius", 5), count("rings", "Rings", 6, 1), count("rays", "Rays", 16, 3)],
    make: ({ radius, rings, rays }) => radial(radius!, rings!, rays!),
  },
];

function grid(width: number, depth: number, rise: number, across: number, along: number): Shape {
  const at = (i: number, j: number) => i * (along + 1) + j;
  const particles: Point[] = [];
  const faces: number[][] = [];
  for (let i = 0; i <= across; i++)
    for (let j = 0; j <= along; j++) {
      const [u, v] = [i / across, j / along];
      particles.push([width * u, depth * v, rise * (u * (1 - v) + v * (1 - u))]);
      if (i < across && j < along) faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
  return { particles, pairs: [], faces, held: [at(0, 0), at(0, along), at(across, 0), at(across, along)] };
}

function radial(radius: number, rings: number, rays: number): Shape {
  const at = (ring: number, ray: number) => (ring ? 1 + (ring - 1) * rays + (ray % rays) : 0);
  const particles: Point[] = [[0, 0, 0]];
  const faces: number[][] = [];
  for (let ring = 1; ring <= rings; ring++)
    for (let ray = 0; ray < rays; ray++) {
      const [r, a] = [(radius * ring) / rings, (2 * Math.PI * ray) / rays];
      particles.push([r * Math.cos(a), r * Math.sin(a), 0]);
      const [p, q] = [at(ring, ray), at(ring, ray + 1)];
      faces.push(ring === 1 ? [0, p, q, q] : [at(ring - 1, ray), p, q, at(ring - 1, ray + 1)]);
    }
  const held = Array.from({ length: rays }, (_, ray) => at(rings, ray));
  return { particles, pairs: [], faces, held };
}

/** A scene of a shape: springs of one stiffness, whose rest length is a factor of the drawn one. */
export function sceneOf(shape: Shape, units: object, stiffness: number, factor: number): Record<string, unknown> {
  const { particles, pairs, faces, held } = shape;
  const place = faces.length ? { mesh: "net" } : { particles: pairs };
  return {
    units,
    particles,
    ...(faces.length && { meshes: { net: { vertices: particles, faces } } }),
    forces: [{ kind: "springs", name: "net", ...place, stiffness, rest_factor: factor }],
    anchors: [{ name: "held", particles: held }],
  };
}
