// A slider with its number. A drag, or strokes of keys in a row, are one gesture: taken back as one.
import { signal, useSignal } from "@preact/signals";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { gesture, Newest } from "../hand";
import type { Bounds, Patch } from "../model";
import type { Session } from "../session";
import { around, outgrown, type Range, rounded, stepOf } from "./amounts";
import { NumberField } from "./number";
import { measured } from "./words";

interface Led {
  session: Session;
  /** What it leads, such as "net stiffness", and what stands before it. */
  name: string;
  seen: string;
  value: number;
  unit: string;
  hint: string;
  /** Said below, such as of how many it is the largest. */
  note?: string;
  bounds: Bounds | undefined;
  log: boolean;
  whole?: boolean;
  patch: (value: number) => Patch;
}

const IN_A_ROW = 1000;
/** How long a value that was accepted is shown until the session tells it. */
const TOLD = 30_000;

/** Whether Shift is down: sliders go wide. */
const wide = signal(false);
for (const type of ["keydown", "keyup"] as const)
  window.addEventListener(type, (event) => (wide.value = event.shiftKey), { capture: true });
window.addEventListener("blur", () => (wide.value = false));

export function Slider({ session, name, seen, value, unit, hint, note, bounds, log, whole, patch }: Led) {
  const hand = useHand(session, patch);
  return (
    <Track
      name={name}
      seen={seen}
      shown={hand.value ?? value}
      unit={unit}
      hint={hint}
      note={note}
      bounds={bounds}
      log={log}
      whole={whole === true}
      held={hand.held}
      live={session.connection.value === "live"}
      lead={hand.lead}
      press={hand.press}
      let={hand.let}
    />
  );
}

interface Own {
  name: string;
  seen: string;
  value: number;
  unit: string;
  hint: string;
  note?: string;
  lead: (value: number) => void;
}

/** A slider of a value that this page has by itself, such as the target of a goal. */
export function Lead({ name, seen, value, unit, hint, note, lead }: Own) {
  const held = useSignal(false);
  return (
    <Track
      name={name}
      seen={seen}
      shown={value}
      unit={unit}
      hint={hint}
      note={note}
      bounds={undefined}
      log={false}
      whole={false}
      held={held.value}
      live
      lead={lead}
      press={() => (held.value = true)}
      let={() => (held.value = false)}
    />
  );
}

interface Tracked {
  name: string;
  seen: string;
  shown: number;
  unit: string;
  hint: string;
  note: string | undefined;
  bounds: Bounds | undefined;
  log: boolean;
  whole: boolean;
  /** Whether a hand is on it. */
  held: boolean;
  live: boolean;
  lead: (value: number) => void;
  press: () => void;
  let: () => void;
}

function Track({ name, seen, shown, unit, hint, note, bounds, log, whole, ...hand }: Tracked) {
  const { held, live, lead, press, let: free } = hand;
  const range = useRange(shown, bounds, log, held, wide.value);
  const step = whole && !range.log ? 1 : stepOf(range);
  const at = (x: number) => (range.log ? Math.log10(x) : x);
  const from = (position: number) => {
    const found = range.log ? rounded(10 ** position) : position;
    return whole ? Math.round(found) : found;
  };
  return (
    <div class={live ? "slider" : "slider stale"}>
      <NumberField
        name={name}
        seen={seen}
        value={shown}
        unit={unit}
        hint={hint}
        bounds={bounds}
        whole={whole}
        disabled={!live}
        stale={!live}
        done={(typed) => typed !== null && lead(typed)}
      />
      <input
        type="range"
        aria-label={name}
        aria-valuetext={measured(shown, unit)}
        title={hint && `${hint.replace(/\.$/, "")}. Shift: a wider range; any value can be typed`}
        disabled={!live}
        min={at(range.low)}
        max={at(range.high)}
        step={step}
        value={at(Math.min(range.high, Math.max(range.low, shown)))}
        onPointerDown={press}
        onInput={(event) => lead(from(event.currentTarget.valueAsNumber))}
        onChange={free}
      />
      {note && <p class="note">{note}</p>}
    </div>
  );
}

/** What the hand wants, until the page has read the scene with it: `value` is null where it wants nothing. A scene that
 * arrives late has an older value, to which the slider must not jump back. */
function useHand(session: Session, patch: (value: number) => Patch) {
  const wanted = useSignal<number | null>(null);
  const edits = useMemo(() => new Newest(session), [session]);
  const held = useRef(false);
  const last = useRef(0);
  const named = useRef("");
  const timer = useRef(0);
  const known = session.read.value;
  const giveWay = () => {
    if (!held.current && !edits.busy && session.read.peek() >= edits.revision) wanted.value = null;
  };
  useEffect(giveWay, [known]);
  useEffect(() => () => clearTimeout(timer.current), []);
  const renew = () => (named.current = gesture("slider"));
  const lead = (to: number) => {
    if (!held.current && performance.now() - last.current > IN_A_ROW) renew();
    last.current = performance.now();
    wanted.value = to;
    edits.put({ ...patch(to), gesture: named.current });
    if (!held.current) settle();
  };
  const settle = () => {
    clearTimeout(timer.current);
    void edits.settled().then(() => {
      giveWay();
      clearTimeout(timer.current);
      // where it was refused, the old one stands; another service begins its revisions at 0
      timer.current = window.setTimeout(() => (wanted.value = null), session.said.value ? 0 : TOLD);
    });
  };
  const press = () => {
    held.current = true;
    clearTimeout(timer.current);
    renew();
  };
  const release = () => {
    held.current = false;
    settle();
  };
  return { value: wanted.value, held: held.current, lead, press, let: release };
}

/** A range that stays while a hand is on the slider, and grows where the hand came to its end. */
function useRange(value: number, bounds: Bounds | undefined, log: boolean, held: boolean, isWide: boolean): Range {
  const range = useRef<{ of: Range; isWide: boolean } | null>(null);
  const now = range.current;
  if (!now || (!held && (now.isWide !== isWide || outgrown(now.of, value, bounds))))
    range.current = { of: around(value, bounds, log, isWide), isWide };
  return range.current!.of;
}
