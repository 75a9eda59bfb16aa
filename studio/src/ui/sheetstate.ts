// The import sheet of a file: what the service drafts for it, what was chosen, and what that was before.
import { batch, computed, signal } from "@preact/signals";
import * as api from "../api";
import type { Choices, Draft, Drawn, Row, Units, Values } from "../model";
import { met } from "./place";
import { plain } from "./words";

interface Chosen {
  role: string;
  values: Values;
}

/** What was chosen, with the draft of it. Rows and objects that are not in the maps have the roles of the service. */
interface State {
  draft: Draft;
  rows: ReadonlyMap<string, Chosen>;
  objects: ReadonlyMap<string, Chosen>;
  weld: number | null;
}

/** The file whose sheet is shown; null for none. */
export const file = signal<File | null>(null);
const states = signal<State[]>([]);
/** Whether the service drafts what was chosen last. */
export const busy = signal(false);
/** Why something was refused; "" for nothing. */
export const refused = signal("");
/** The recipe as somebody changed it by hand; null: that of the draft. */
export const edited = signal<string | null>(null);

const state = computed(() => states.value.at(-1) ?? null);
export const draft = computed(() => state.value?.draft ?? null);
export const undoable = computed(() => states.value.length > 1 && !busy.value);
export const recipe = computed(() => edited.value ?? JSON.stringify(draft.value?.recipe, null, 2));

/** What the service drafts at present: a further choice goes on from it, and its answer is not awaited any more. */
let wanted: State | null = null;

const keyOf = (row: Row) => `${row.family} ${row.layer}`;

/** Show the sheet of a file; false where there is nothing drawn in it. Rejects with Refused. */
export async function drafted(opened: File): Promise<boolean> {
  const found = await api.draft(opened);
  if (!found.rows.length) return false;
  batch(() => {
    states.value = [{ draft: found, rows: new Map(), objects: new Map(), weld: null }];
    settle();
    file.value = opened;
  });
  return true;
}

export function close(): void {
  file.value = null;
  settle();
}

export function undo(): void {
  if (!undoable.value) return;
  states.value = states.value.slice(0, -1);
  settle();
}

export const chooseRow = (row: Row, role: string, values: Values = {}) =>
  change((now) => ({ ...now, rows: new Map(now.rows).set(keyOf(row), { role, values }) }));

/** Give an object a role of its own; "" takes it away again. */
export const chooseObject = (drawn: Drawn, role: string, values: Values = {}) =>
  change((now) => {
    const objects = new Map(now.objects);
    if (role) objects.set(drawn.id, { role, values });
    else objects.delete(drawn.id);
    return { ...now, objects };
  });

export const chooseWeld = (weld: number | null) => change((now) => ({ ...now, weld }));

/** Other units of the recipe: all values and tolerances are converted by the service. */
export const chooseUnits = (units: Units) => change((now) => ({ ...now, weld: null }), units);

async function change(made: (now: State) => State, units?: Units): Promise<void> {
  const now = wanted ?? state.value;
  const opened = file.value;
  if (!now || !opened) return;
  const next = (wanted = made(now));
  busy.value = true;
  try {
    const found = await api.draft(opened, choices(next, units ?? now.draft.units));
    if (wanted !== next) return;
    batch(() => {
      states.value = [...states.value, units ? { ...converted(next, found), draft: found } : { ...next, draft: found }];
      settle();
    });
  } catch (error) {
    if (wanted !== next) return;
    met(error);
    settle();
    refused.value = plain(error instanceof Error ? error.message : String(error));
    // what was chosen in a menu is shown as it was before
    states.value = states.value.map((one) => ({ ...one, draft: { ...one.draft } }));
  }
}

/** Nothing is awaited any more: what is shown is what holds. */
function settle(): void {
  wanted = null;
  batch(() => {
    busy.value = false;
    refused.value = "";
    edited.value = null;
  });
}

function choices({ draft, rows, objects, weld }: State, units: Units): Choices {
  const chosen = draft.rows.flatMap((row) => {
    const found = rows.get(keyOf(row));
    return found ? [{ layer: row.layer, family: row.family, ...found }] : [];
  });
  const single = [...objects].map(([id, found]) => ({ id, ...found }));
  return { units, values_in: draft.units, weld_tolerance: weld, rows: chosen, objects: single };
}

/** The choices with their values as the draft in other units has them. */
function converted(now: State, found: Draft): State {
  const rows = new Map(now.rows);
  const objects = new Map(now.objects);
  for (const row of found.rows) {
    if (rows.has(keyOf(row))) rows.set(keyOf(row), { role: row.role, values: row.values });
    for (const { id, role, values } of row.objects) if (role && objects.has(id)) objects.set(id, { role, values });
  }
  return { ...now, rows, objects };
}
