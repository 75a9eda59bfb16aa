// Families of scenes to begin with, as the service describes them.
import { signal } from "@preact/signals";
import * as api from "../api";
import type { Family, Field, Units } from "../model";
import { titled, unit } from "./words";

/** Null until they are read. */
export const families = signal<Family[] | null>(null);

let reading = false;

/** Read them, where they are not known yet. */
export async function knowFamilies(): Promise<void> {
  if (reading || families.value) return;
  reading = true;
  try {
    families.value = await api.families();
  } finally {
    reading = false;
  }
}

/** How a parameter is seen: its name, unit, and its description without the unit. */
export const seenOf = (field: Field, units: Units) => ({
  seen: titled(field.name),
  unit: unit(field.unit, units),
  hint: field.description.replace(/ \[[^\]]*\]$/, ""),
  whole: field.type === "whole number",
});
