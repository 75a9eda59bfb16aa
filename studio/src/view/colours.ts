// Colours of the view: those of the pictures that the command line writes, and their like on dark ground.
import { Color, ColorManagement } from "three";

// shaders write colours as a screen takes them
ColorManagement.enabled = false;

export interface Palette {
  ground: string;
  ink: string;
  /** Springs and edges that carry no number. */
  plain: string;
  slack: string;
  skin: string;
  edge: string;
  dot: string;
  load: string;
  reaction: string;
  floor: string;
  /** What forces pull to. */
  guide: string;
  accent: string;
  /** A variant over the form. */
  variant: string;
  /** Ways of water. */
  water: string;
  warning: string;
  cold: string[];
  middle: string;
  warm: string[];
}

const LIGHT: Palette = {
  ground: "#f7f8fa",
  ink: "#22303c",
  plain: "#52606d",
  slack: "#b9c0c7",
  skin: "#cfe1f2",
  edge: "#7d90a3",
  dot: "#ffffff",
  load: "#2a9d5c",
  reaction: "#8e44ad",
  floor: "#b4bec8",
  guide: "#8a6d1f",
  accent: "#e08a00",
  variant: "#00857a",
  water: "#1666c0",
  warning: "#d6186b",
  cold: ["#06306e", "#1f66b0", "#5ea2d6", "#a9c9e2"],
  middle: "#d3d3d3",
  warm: ["#f3b58e", "#e27a4c", "#c2352b", "#6f0a1e"],
};

// on dark ground the strongest are the lightest, with the same hues
const DARK: Palette = {
  ground: "#12171d",
  ink: "#eef2f6",
  plain: "#9fb0c0",
  slack: "#5b6670",
  skin: "#46586b",
  edge: "#70849a",
  dot: "#1d252e",
  load: "#4fce86",
  reaction: "#c58be0",
  floor: "#4a5764",
  guide: "#d6b656",
  accent: "#ffb84d",
  variant: "#3fd9c8",
  water: "#6db4ff",
  warning: "#ff6fae",
  cold: ["#cfe6ff", "#86c0ff", "#4d94e6", "#3d6fa8"],
  middle: "#6a737c",
  warm: ["#a8603f", "#e4703e", "#ff9a6b", "#ffd9c2"],
};

export const palette = (dark: boolean): Palette => (dark ? DARK : LIGHT);

export interface Ramp {
  colours: string[];
  first: number;
  last: number;
}

/** Colours at even steps and the numbers at their two ends: about 0 where both signs occur, else over the extremes. */
export function ramp(low: number, high: number, dark: boolean): Ramp {
  const { cold, middle, warm } = palette(dark);
  if (!(low <= high)) [low, high] = [0, 0];
  const largest = Math.max(Math.abs(low), Math.abs(high));
  if (low < -1e-9 * largest && high > 1e-9 * largest) {
    return { colours: [...cold, middle, ...warm], first: -largest, last: largest };
  }
  const margin = high > low ? 0 : Math.max(Math.abs(high), 1) * 1e-3;
  const pushed = high <= 1e-9 * largest && largest > 0;
  return { colours: pushed ? cold : warm, first: low - margin, last: high + margin };
}

/** A CSS colour as red, green and blue from 0 to 1, as a screen takes them. */
export function channels(css: string): [number, number, number] {
  return new Color(css).toArray() as [number, number, number];
}
