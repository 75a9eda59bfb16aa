// What is under the pointer: a search over what is drawn, on the picture.
import { Matrix4, type PerspectiveCamera } from "three";
import type { Picked } from "./types";

const KEPT = 24;
/** A held particle is found from this much farther away than a free one: its mark is larger. */
const HELD = 5;

export interface Searched {
  camera: PerspectiveCamera;
  /** Of the canvas [CSS pixels]. */
  width: number;
  height: number;
  positions: Float32Array;
  springs: Int32Array;
  /** Faces that hide what is behind them. */
  triangles: Uint32Array;
  held: ReadonlySet<number>;
  /** So much in front of a thing, a face does not hide it [length]. */
  thickness: number;
}

interface Found {
  index: number;
  x: number;
  y: number;
  depth: number;
  rank: number;
}

export class Picker {
  /** x y and depth of each particle on the picture; depth 0 for those behind the eye. */
  private screen = new Float32Array();
  private readonly matrix = new Matrix4();

  /** What a press at x, y takes; `reach` is how far away a particle and a spring may be [CSS pixels]. */
  find(x: number, y: number, among: Searched, reach: { particle: number; spring: number }): Picked {
    this.place(among);
    const particle = this.shown(this.particles(x, y, among, reach.particle), among);
    if (particle) return { kind: "particle", index: particle.index };
    const spring = this.shown(this.springs(x, y, among, reach.spring), among);
    return spring && { kind: "spring", index: spring.index };
  }

  /** The foremost triangle under x, y, by its number; -1 for none. */
  triangle(x: number, y: number, among: Searched): number {
    this.place(among);
    const { screen } = this;
    const { triangles } = among;
    let [found, nearest] = [-1, Infinity];
    for (let i = 0; i < triangles.length; i += 3) {
      const depth = depthAt(screen, 3 * triangles[i]!, 3 * triangles[i + 1]!, 3 * triangles[i + 2]!, x, y);
      if (depth < nearest) [found, nearest] = [i / 3, depth];
    }
    return found;
  }

  private place({ camera, width, height, positions }: Searched): void {
    if (this.screen.length !== positions.length) this.screen = new Float32Array(positions.length);
    const { screen } = this;
    camera.updateMatrixWorld();
    const m = this.matrix.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
    for (let i = 0; i < positions.length; i += 3) {
      const x = positions[i]!;
      const y = positions[i + 1]!;
      const z = positions[i + 2]!;
      const w = m[3]! * x + m[7]! * y + m[11]! * z + m[15]!;
      screen[i] = ((m[0]! * x + m[4]! * y + m[8]! * z + m[12]!) / w + 1) * 0.5 * width;
      screen[i + 1] = (1 - (m[1]! * x + m[5]! * y + m[9]! * z + m[13]!) / w) * 0.5 * height;
      screen[i + 2] = w > 0 ? w : 0;
    }
  }

  private particles(x: number, y: number, { held }: Searched, reach: number): Found[] {
    const { screen } = this;
    const found: Found[] = [];
    for (let i = 0; i < screen.length; i += 3) {
      const dx = screen[i]! - x;
      const dy = screen[i + 1]! - y;
      if (dx * dx + dy * dy > reach * reach || screen[i + 2] === 0) continue;
      const index = i / 3;
      const rank = Math.hypot(dx, dy) - (held.has(index) ? HELD : 0);
      keep(found, { index, x: screen[i]!, y: screen[i + 1]!, depth: screen[i + 2]!, rank });
    }
    return found;
  }

  private springs(x: number, y: number, { springs }: Searched, reach: number): Found[] {
    const { screen } = this;
    const found: Found[] = [];
    for (let i = 0; i < springs.length; i += 2) {
      const a = 3 * springs[i]!;
      const b = 3 * springs[i + 1]!;
      const ax = screen[a]!;
      const bx = screen[b]!;
      if ((ax > x + reach && bx > x + reach) || (ax < x - reach && bx < x - reach)) continue;
      const ay = screen[a + 1]!;
      const by = screen[b + 1]!;
      if ((ay > y + reach && by > y + reach) || (ay < y - reach && by < y - reach)) continue;
      const ux = bx - ax;
      const uy = by - ay;
      const t = Math.min(1, Math.max(0, ((x - ax) * ux + (y - ay) * uy) / Math.max(ux * ux + uy * uy, 1e-12)));
      const px = ax + t * ux;
      const py = ay + t * uy;
      const rank = Math.hypot(px - x, py - y);
      if (rank > reach || !screen[a + 2] || !screen[b + 2]) continue;
      keep(found, { index: i / 2, x: px, y: py, depth: 1 / ((1 - t) / screen[a + 2]! + t / screen[b + 2]!), rank });
    }
    return found;
  }

  /** The first that no face hides, else the first. */
  private shown(found: Found[], among: Searched): Found | null {
    // of those equally near to the pointer the one nearest to the eye
    found.sort((a, b) => Math.round(a.rank / 1.5) - Math.round(b.rank / 1.5) || a.depth - b.depth);
    return found.find((one) => !this.hidden(one, among)) ?? found[0] ?? null;
  }

  private hidden({ x, y, depth }: Found, { triangles, thickness }: Searched): boolean {
    const { screen } = this;
    for (let i = 0; i < triangles.length; i += 3) {
      const at = depthAt(screen, 3 * triangles[i]!, 3 * triangles[i + 1]!, 3 * triangles[i + 2]!, x, y);
      if (at < depth - thickness) return true;
    }
    return false;
  }
}

/** How far from the eye a triangle of corners a, b and c is at x, y; infinitely far where it is not there. */
function depthAt(screen: Float32Array, a: number, b: number, c: number, x: number, y: number): number {
  const ax = screen[a]! - x;
  const bx = screen[b]! - x;
  const cx = screen[c]! - x;
  if ((ax > 0 && bx > 0 && cx > 0) || (ax < 0 && bx < 0 && cx < 0)) return Infinity;
  const ay = screen[a + 1]! - y;
  const by = screen[b + 1]! - y;
  const cy = screen[c + 1]! - y;
  const u = bx * cy - by * cx;
  const v = cx * ay - cy * ax;
  const w = ax * by - ay * bx;
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return Infinity;
  const area = u + v + w;
  if (area === 0 || !screen[a + 2] || !screen[b + 2] || !screen[c + 2]) return Infinity;
  return area / (u / screen[a + 2]! + v / screen[b + 2]! + w / screen[c + 2]!);
}

/** Keep the best few. */
function keep(found: Found[], one: Found): void {
  if (found.length < KEPT) {
    found.push(one);
    return;
  }
  let worst = 0;
  for (let i = 1; i < found.length; i++) if (found[i]!.rank > found[worst]!.rank) worst = i;
  if (one.rank < found[worst]!.rank) found[worst] = one;
}
