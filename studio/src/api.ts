// The service over HTTP. Every refusal is a Refused with the service's own sentence.
import { signed } from "./guest";
import type { Action, Anchor, Choices, Draft, Example, Family, Kind, Parameters, Patch, Result } from "./model";
import type { Scene, Shared, Store, Summary, SurfaceRead, Topology } from "./model";

/** What the service refused, in its own words; status 0: it could not be reached. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    sentence: string,
    readonly slug = "",
    readonly errors: { pointer: string; detail: string }[] = [],
  ) {
    super(sentence);
  }
}

/** The Refused of a problem document (RFC 9457). */
export function refusal(status: number, problem: Record<string, unknown>): Refused {
  const errors = (problem["errors"] ?? []) as { pointer: string; detail: string }[];
  const slug = String(problem["type"] ?? "").replace(/^.*\//, "");
  return new Refused(status, String(problem["detail"] ?? `The service answered with ${status}.`), slug, errors);
}

export async function ask(path: string, options: RequestInit = {}): Promise<Response> {
  let answer: Response;
  try {
    answer = await fetch(path, { credentials: "same-origin", ...options, headers: signed(options.headers) });
  } catch {
    const sentence = "The service does not answer. If it has ended, start it with hookean studio, then repeat this.";
    throw new Refused(0, sentence, "unreachable");
  }
  if (answer.ok) return answer;
  const problem = (await answer.json().catch(() => ({}))) as Record<string, unknown>;
  throw refusal(answer.status, problem);
}

export const read = async <T>(path: string): Promise<T> => (await (await ask(path)).json()) as T;

export const send = async <T>(method: string, path: string, body: unknown): Promise<T> => {
  const headers = { "content-type": "application/json" };
  return (await (await ask(path, { method, headers, body: JSON.stringify(body) })).json()) as T;
};

const at = (key: string) => `/v1/sessions/${encodeURIComponent(key)}`;
const labelled = (label: string) => (label ? `?label=${encodeURIComponent(label.slice(0, 200))}` : "");

/** Exchange the token that was behind the # of the address for a cookie. */
export const login = (token: string) =>
  ask("/v1/login", { method: "POST", headers: { authorization: `Bearer ${token}` } });

export const sessions = () => read<{ sessions: Summary[]; store?: Store }>("/v1/sessions");
export const summary = (key: string) => read<Summary>(at(key));
/** Whether a session has a process, and how long that has sent nothing [s]. */
export async function pulse(key: string): Promise<{ awake: boolean; silence: number }> {
  const answer = await ask(at(key));
  const { awake } = (await answer.json()) as Summary;
  return { awake, silence: Number(answer.headers.get("hookean-silence")) };
}
export const topology = (key: string) => read<Topology>(`${at(key)}/topology`);
export const anchors = async (key: string) => (await read<{ anchors: Anchor[] }>(`${at(key)}/anchors`)).anchors;
export const scene = (key: string) => read<Scene>(`${at(key)}/scene`);
export const result = (key: string) => read<Result>(`${at(key)}/state`);

/** The surface of the present shape; `step` null: a round one. */
export const surface = (key: string, step: number | null, drops: number) =>
  read<SurfaceRead>(`${at(key)}/surface?drops=${drops}${step === null ? "" : `&step=${step}`}`);

/** The token of the read-only link of a session; a session without a link gets one. */
export const link = async (key: string) =>
  ((await (await ask(`${at(key)}/guest`, { method: "PUT" })).json()) as { token: string }).token;
/** Whether a session has such a link. */
export const linked = async (key: string) => (await read<{ token: string | null }>(`${at(key)}/guest`)).token !== null;
export const unlink = (key: string) => ask(`${at(key)}/guest`, { method: "DELETE" });

export const act = (key: string, action: Action) => ask(`${at(key)}/${action}`, { method: "POST" });
export const forget = (key: string) => ask(at(key), { method: "DELETE" });

/** An edit that is too long for a message over the socket. */
export const edit = (key: string, patch: Patch) => send<Summary>("PATCH", at(key), patch);

/** A title that no session has: with a number behind it where there is one of that name. */
async function untaken(title: string): Promise<string> {
  const taken = new Set((await sessions()).sessions.map(({ label }) => label));
  let free = title;
  for (let number = 2; free && taken.has(free); number++) free = `${title} ${number}`;
  return free;
}

/** A new session of a scene. */
export const create = async (scene: unknown, title = "") =>
  send<Summary>("POST", `/v1/sessions${labelled(await untaken(title))}`, scene);

/** Another name to display. */
export const rename = async (key: string, label: string) =>
  (await (await ask(`${at(key)}/label${labelled(label)}`, { method: "PUT" })).json()) as Summary;

/** Another session that goes on from where one is, paused. */
export const branch = async (key: string, label: string) =>
  (await (await ask(`${at(key)}/branches${labelled(label)}`, { method: "POST" })).json()) as Summary;

/** Families of scenes, each with its parameters. */
export const families = async () => (await read<{ families: Family[] }>("/v1/families")).families;

/** The scene of a family. */
export const familyScene = (name: string, units: object, parameters: Parameters) =>
  send<Scene>("POST", `/v1/families/${encodeURIComponent(name)}`, { units, parameters });

/** A new session of a file: .3dm (by a recipe, or as drawn), .obj, COMPAS JSON, a scene or a saved simulation. */
export async function open(file: File, recipe = ""): Promise<Summary & { warnings?: string[] }> {
  const body = new FormData();
  body.append("file", file, file.name);
  if (recipe) body.append("recipe", recipe);
  const title = await untaken(file.name.replace(/\.hookean$/, ""));
  const answer = await ask(`/v1/sessions${labelled(title)}`, { method: "POST", body });
  return (await answer.json()) as Summary;
}

/** The layers of a .3dm, OBJ or COMPAS file with a role for each, by guess or by choice. */
export async function draft(file: File, choices?: Choices): Promise<Draft> {
  const body = new FormData();
  body.append("file", file, file.name);
  if (choices) body.append("choices", JSON.stringify(choices));
  return (await (await ask("/v1/recipes", { method: "POST", body })).json()) as Draft;
}

export type Format = "hookean" | "scene" | "3dm" | "obj" | "compas" | "csv" | "npz";

/** The session as a file, and sentences on what that does not hold. */
export async function exported(key: string, format: Format): Promise<{ blob: Blob; notes: string[] }> {
  const answer = await ask(format === "scene" ? `${at(key)}/scene` : `${at(key)}/state?format=${format}`);
  const notes = JSON.parse(answer.headers.get("hookean-warnings") ?? "[]") as string[];
  return { blob: await answer.blob(), notes };
}

/** What programs and pages share about a session beside its model. */
export const shared = (key: string) => read<Shared>(`${at(key)}/view`);
export const share = (key: string, view: Partial<Shared>) => send<Shared>("PATCH", `${at(key)}/view`, view);

/** The catalogue of forces: fields, units, defaults, bounds. */
export const catalogue = async () => (await read<{ forces: Kind[] }>("/v1/forces")).forces;

/** What the service takes and gives, as OpenAPI has it. */
export const openapi = () => read<{ components: { schemas: Record<string, unknown> } }>("/v1/openapi.json");

export const examples = async () => (await read<{ examples: Example[] }>("/v1/examples")).examples;
export const exampleScene = (id: string) => read<Scene>(`/v1/examples/${encodeURIComponent(id)}/scene`);
