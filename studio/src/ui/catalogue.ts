// What may be set, as the service describes it: kinds of forces, and settings.
import { signal } from "@preact/signals";
import * as api from "../api";
import type { Bounds, Field, Kind } from "../model";
import { type OneOf, type Quantity, quantitiesOf } from "../quantities";

/** Kinds of forces by their name, the settings, and what goals of a design measure; null until they are read. */
export const kinds = signal<Map<string, Kind> | null>(null);
export const settings = signal<Field[] | null>(null);
export const quantities = signal<Map<string, Quantity> | null>(null);

let reading = false;

/** Read them, where they are not known yet. */
export async function know(): Promise<void> {
  if (reading || (kinds.value && settings.value)) return;
  reading = true;
  try {
    const [forces, described] = await Promise.all([api.catalogue(), api.openapi()]);
    kinds.value = new Map(forces.map((kind) => [kind.kind, kind]));
    settings.value = fields(described.components.schemas["Settings"] as Described);
    quantities.value = quantitiesOf(described.components.schemas["DesignGoal"] as OneOf);
  } finally {
    reading = false;
  }
}

interface Described {
  properties: Record<string, Property>;
}

interface Property {
  description?: string;
  default?: unknown;
  type?: string;
  enum?: string[];
  minimum?: number;
  maximum?: number;
  exclusiveMinimum?: number;
  exclusiveMaximum?: number;
}

const fields = (described: Described) =>
  Object.entries(described.properties).map(([name, property]) => field(name, property));

function field(name: string, property: Property): Field {
  const description = property.description ?? "";
  const unit = /\[([^\]]*)\]/.exec(description)?.[1] ?? "-";
  const { minimum, maximum, exclusiveMinimum: more_than, exclusiveMaximum: less_than } = property;
  const told: [string, number | undefined][] = Object.entries({ minimum, maximum, more_than, less_than });
  const bounds: Bounds = Object.fromEntries(told.filter(([, bound]) => bound !== undefined));
  const type = property.type === "integer" ? "whole number" : (property.type ?? "object");
  return {
    name,
    description,
    unit,
    type,
    default: property.default,
    bounds,
    ...(property.enum && { choices: property.enum }),
  };
}
