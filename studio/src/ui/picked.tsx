// The picked particle or spring in numbers; both can be picked by number, too.
import { Grip, holder, inTurn, pin, release } from "../hand";
import type { Anchor, Point } from "../model";
import type { Session } from "../session";
import type { View } from "../view/types";
import { NumberField } from "./number";
import type { Studio } from "./studio";
import { measured, said } from "./words";

export function PickedPanel({ studio }: { studio: Studio }) {
  const { options, session, view } = studio;
  const picked = options.picked.value;
  const topology = session.topology.value;
  const choose = (kind: "particle" | "spring") => (index: number | null) => {
    options.picked.value = index === null ? null : { kind, index };
    const particles = index === null ? [] : kind === "particle" ? [index] : (topology?.springs[index] ?? []);
    if (!particles.every((particle) => isSeen(view.value, particle))) view.value?.show([...particles]);
  };
  const number = (kind: "particle" | "spring", seen: string, count: number) => (
    <NumberField
      name={`${seen} number`}
      seen={seen}
      value={picked?.kind === kind ? picked.index : null}
      unit=""
      whole
      hint={`Pick a ${kind} by its number`}
      placeholder={count ? `0 to ${count - 1}` : "none"}
      bounds={{ minimum: 0, maximum: count - 1 }}
      disabled={!count}
      done={choose(kind)}
    />
  );
  return (
    <>
      <div class="row">
        {number("particle", "Particle", topology?.particles ?? 0)}
        {number("spring", "Spring", topology?.springs.length ?? 0)}
      </div>
      {picked && options.still.value && (
        <p class="note">Present values. The canvas shows: {options.still.value.said}.</p>
      )}
      {!picked && <p class="faint">Click a particle or a spring, or give its number.</p>}
      {picked?.kind === "particle" && <Particle key={picked.index} studio={studio} index={picked.index} />}
      {picked?.kind === "spring" && <Spring key={picked.index} studio={studio} index={picked.index} />}
    </>
  );
}

/** Whether a particle is drawn somewhere on the screen. */
function isSeen(view: View | null, particle: number): boolean {
  const at = view?.project(particle);
  const canvas = document.querySelector("canvas")?.getBoundingClientRect();
  return !!at && !!canvas && at.x > canvas.left && at.x < canvas.right && at.y > canvas.top && at.y < canvas.bottom;
}

interface Shown {
  studio: Studio;
  index: number;
}

/** Whether numbers of the frame are of now, and the frame; reading it shows them again with each frame. */
function newest(session: Session) {
  void session.ticks.value;
  const { frame } = session;
  return { frame, stale: session.connection.value !== "live" || !frame };
}

function Particle({ studio, index }: Shown) {
  const { session } = studio;
  const { frame, stale } = newest(session);
  const { length = "", force = "" } = session.topology.value?.units ?? {};
  const anchor = holder(session.anchors.value, index);
  const at = frame && pointOf(frame.positions, index);
  const start = session.topology.value?.start[index];
  const reaction = frame && reactionOn(session.anchors.value, frame.reactions, index);
  return (
    <div class={stale ? "stale" : ""}>
      <h3>Particle {index}</h3>
      <Position studio={studio} index={index} at={at} anchor={anchor} stale={stale} />
      <dl>
        <Told name="Held" value={heldBy(anchor)} />
        {at && start && <Told name="Displacement" value={measured(distance(at, start), length)} />}
        {anchor && <Told name="Reaction" value={reaction ? vector(reaction, force) : "-"} />}
        <Loads studio={studio} index={index} unit={force} />
      </dl>
      {!session.readOnly && (
        <button
          type="button"
          disabled={stale}
          aria-keyshortcuts="p"
          onClick={() => void (anchor ? release : pin)(session, index)}
        >
          {anchor ? "Release" : "Pin"}
        </button>
      )}
    </div>
  );
}

/** To a coordinate; one that is typed quickly after another keeps that one. */
async function moved(session: Session, index: number, axis: number, to: number): Promise<void> {
  const held = holder(await session.anchorsOfNow(), index);
  const now = held?.targets[held.particles.indexOf(index)];
  if (!now) return;
  const grip = new Grip(session, index);
  grip.lead(now.map((old, other) => (other === axis ? to : old)) as Point);
  await grip.drop();
}

/** The position of a particle, which can be typed if it is held. */
function Position({
  studio: { session },
  index,
  at,
  anchor,
  stale,
}: Shown & { at: Point | null; anchor: Anchor | undefined; stale: boolean }) {
  const unit = session.topology.value?.units.length ?? "";
  const move = (axis: number) => (to: number | null) => {
    if (to !== null) inTurn(() => moved(session, index, axis, to));
  };
  return (
    <div class="components" role="group" aria-label={`Position of particle ${index}`}>
      <span class="seen">Position</span>
      {[0, 1, 2].map((axis) =>
        anchor?.axes.includes("xyz"[axis]!) ? (
          <NumberField
            key={axis}
            name={"xyz"[axis]!}
            seen={"xyz"[axis]!}
            value={at?.[axis] ?? null}
            unit=""
            hint="Type a coordinate to move the anchor"
            disabled={stale || session.readOnly}
            stale={stale}
            done={move(axis)}
          />
        ) : (
          <span key={axis} class="field">
            <span>{"xyz"[axis]}</span> <output class="number">{at ? said(at[axis]!, 5) : "-"}</output>
          </span>
        ),
      )}
      <span class="unit">{unit}</span>
    </div>
  );
}

function Loads({ studio, index, unit }: Shown & { unit: string }) {
  const read = studio.readings.loads(index);
  if (!read) return <Told name="Load" value="reading ..." stale />;
  if (!read.loads.length) return <Told name="Load" value="none" stale={!read.now} />;
  return read.loads.map((load) => (
    <Told key={load.name} name={`Load: ${load.name}`} value={vector(load.vector, unit)} stale={!read.now} />
  ));
}

function Spring({ studio, index }: Shown) {
  const { session, options } = studio;
  const { frame, stale } = newest(session);
  const topology = session.topology.value;
  const ends = topology?.springs[index];
  if (!topology || !ends) return <p class="faint">Spring {index} does not exist.</p>;
  const { length: inLength, force: inForce } = topology.units;
  const owner = topology.forces[topology.spring_forces[index]!];
  const length = frame ? distance(pointOf(frame.positions, ends[0]), pointOf(frame.positions, ends[1])) : NaN;
  const force = frame?.springForces[index] ?? NaN;
  const rest = options.restLengths.value?.[index] ?? NaN;
  const restNow = studio.readings.isCurrent();
  const strain =
    rest > 0 ? `${said(100 * (length / rest - 1))} %` : rest === 0 ? "undefined: the rest length is 0" : "reading ...";
  return (
    <div class={stale ? "stale" : ""}>
      <h3>Spring {index}</h3>
      <dl>
        <Told name="Part of" value={owner?.name || owner?.kind || "-"} />
        <Told name="Ends" value={`particles ${ends[0]} and ${ends[1]}`} />
        <Told name="Length" value={measured(length, inLength)} />
        <Told
          name="Rest length"
          value={Number.isFinite(rest) ? measured(rest, inLength) : "reading ..."}
          stale={!restNow}
        />
        <Told
          name="Force"
          value={`${measured(force, inForce)}${force > 0 ? " tension" : force < 0 ? " compression" : ""}`}
        />
        <Told name="Strain" value={strain} stale={!restNow} />
      </dl>
    </div>
  );
}

const Told = ({ name, value, stale = false }: { name: string; value: string; stale?: boolean }) => (
  <div>
    <dt>{name}</dt>
    <dd class={stale ? "number stale" : "number"}>{value}</dd>
  </div>
);

function heldBy(anchor: Anchor | undefined): string {
  if (!anchor) return "no, free";
  const along = anchor.axes === "xyz" ? "" : ` along ${[...anchor.axes].join(" and ")}`;
  return (
    (anchor.name ? `by anchor ${anchor.name}` : anchor.number >= 0 ? `by anchor ${anchor.number}` : "pinned") + along
  );
}

const pointOf = (all: Float32Array, index: number): Point => [
  all[3 * index]!,
  all[3 * index + 1]!,
  all[3 * index + 2]!,
];

const distance = (a: Point, b: Point) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

const vector = (v: Point, unit: string) =>
  `${measured(Math.hypot(...v), unit)} (${v.map((n) => said(n, 3)).join(", ")})`;

/** The reaction on a held particle; null where the frame is of other anchors. */
export function reactionOn(anchors: Anchor[], reactions: Float32Array, index: number): Point | null {
  const held = [...new Set(anchors.flatMap((anchor) => anchor.particles))].sort((a, b) => a - b);
  const place = held.indexOf(index);
  return place >= 0 && reactions.length === 3 * held.length ? pointOf(reactions, place) : null;
}
