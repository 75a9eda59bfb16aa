// Where the page is, which the address says: #s=KEY is a session, nothing the start page; #t=TOKEN logs in.
import { signal } from "@preact/signals";
import * as api from "../api";
import { guest } from "../guest";
import { keepLooked } from "./looked";

/** Key of the session that is shown; "" on the start page; null while the address is read. */
export const place = signal<string | null>(null);
/** Whether this browser is logged in, as far as it is known. */
export const entry = signal<"asking" | "in" | "out">(guest ? "in" : "asking");
/** Counts log-ins: what was refused before one is tried again after it. */
export const entries = signal(0);
/** Why a token was refused; "" for nothing. */
export const refusedEntry = signal("");

/** The address of a session on this page, which opens it wherever it is pasted. */
export const linkTo = (key: string) => `#s=${encodeURIComponent(key)}`;

/** Show a session; the page before is a step back away. */
export function go(key: string): void {
  history.pushState(null, "", key ? linkTo(key) : location.pathname);
  read();
}

const RENEWING = 3600e3; // ms; a cookie that is not used for 12 hours is worth nothing

let isFirst = true;
/** Counts readings of the address: a view that is unpacked late is not shown. */
let turns = 0;

/** To be called by a page when it is there: all but the first are read from their beginning. */
export function arrive(): void {
  if (!isFirst) {
    document.querySelector(".shown")?.scrollTo(0, 0);
    document.getElementById("main")?.focus({ preventScroll: true });
  }
  isFirst = false;
}

/** Follow the address from now on, and log in where it has a token. */
export function begin(): void {
  window.addEventListener("popstate", () => read());
  window.addEventListener("hashchange", () => read());
  if (guest) {
    window.addEventListener("hashchange", () => location.reload()); // of another link, or none
    read();
    return;
  }
  // another page of this browser may have logged in or out meanwhile; the cookie is renewed by being used
  document.addEventListener("visibilitychange", () => document.hidden || void look());
  window.addEventListener("focus", () => void look());
  window.setInterval(() => void look(), RENEWING);
  if (!read()) void look();
}

/** Log in with a token, or with the whole address that has one. */
export async function enter(told: string): Promise<void> {
  const token = told.trim().replace(/^.*#(.*&)?t=([^&]*).*$/, "$2");
  try {
    await api.login(token);
    refusedEntry.value = "";
    entry.value = "in";
    entries.value += 1;
  } catch (error) {
    refusedEntry.value = error instanceof Error ? error.message : String(error);
    entry.value = "out";
    // a page that is read again has a code that was used, and the cookie that it got for it
    void look();
  }
}

/** Call this with each refusal: if the log-in has expired, the log-in form is shown. */
export function met(error: unknown): void {
  if (error instanceof api.Refused && (error.status === 401 || error.status === 403)) entry.value = "out";
}

/** Read the address; whether it had a token. */
function read(): boolean {
  const told = new URLSearchParams(location.hash.slice(1));
  const token = told.get("t");
  const key = told.get("s") ?? "";
  const view = told.get("v");
  if (token) {
    // neither the history nor a copied address keeps the token
    history.replaceState(null, "", key ? linkTo(key) : location.pathname);
    if (guest) location.reload();
    void enter(token);
  }
  const turn = ++turns;
  const show = () => turn === turns && (place.value = key);
  if (key && view) void keepLooked(key, view).then(show);
  else show();
  return token !== null;
}

async function look(): Promise<void> {
  try {
    await api.sessions();
    if (entry.value === "out") entries.value += 1;
    entry.value = "in";
  } catch (error) {
    met(error);
    // a service that does not answer is reported by the next request
    if (entry.value === "asking") entry.value = "in";
  }
}
