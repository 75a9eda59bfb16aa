// The last minute of a session as small charts, each with its newest number.
import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import type { Units } from "../model";
import type { Session } from "../session";
import { PickedCharts } from "./pickedcharts";
import { Recording, type Sample } from "./recording";
import type { Studio } from "./studio";
import { dark } from "./theme";
import { measured, said } from "./words";

interface Line {
  name: string;
  of: Exclude<keyof Sample, "at">;
  unit: (units: Units | undefined) => string;
  log?: boolean;
}

const energy = (units: Units | undefined) => (units ? `${units.force}·${units.length}` : "");

const LINES: Line[] = [
  { name: "Time", of: "time", unit: (units) => units?.time ?? "" },
  { name: "Iteration", of: "iteration", unit: () => "" },
  { name: "Residual", of: "residual", unit: () => "", log: true },
  { name: "Kinetic energy", of: "kinetic", unit: energy },
  { name: "Total energy", of: "total", unit: energy },
];

export function Charts({ studio }: { studio: Studio }) {
  const { session } = studio;
  const recording = useRef<Recording | null>(null);
  recording.current ??= new Recording(session);
  useEffect(() => recording.current!.begin(), []);
  return (
    <div class="charts">
      <PickedCharts studio={studio} />
      {LINES.map((line) => (
        <Chart key={line.of} line={line} session={session} recording={recording.current!} />
      ))}
    </div>
  );
}

interface Shown {
  line: Line;
  session: Session;
  recording: Recording;
}

function Chart({ line, session, recording }: Shown) {
  const place = useRef<HTMLDivElement>(null);
  const isDark = dark.value;
  useEffect(() => {
    if (!place.current) return;
    const plot = plotted(line, place.current);
    let isSeen = false; // a panel that is closed, or scrolled out of sight, draws nothing
    const show = () => {
      if (isSeen) plot.setData([recording.times(), recording.of(line.of)]);
    };
    const sight = new IntersectionObserver((told) => {
      isSeen = told.at(-1)!.isIntersecting;
      show();
    });
    sight.observe(place.current);
    const sizes = new ResizeObserver(([entry]) => {
      const width = Math.floor(entry?.contentRect.width ?? 0);
      if (width > 0 && width !== plot.width) plot.setSize({ width, height: HEIGHT });
      show();
    });
    sizes.observe(place.current);
    const stop = recording.onNew(show);
    return () => {
      stop();
      sizes.disconnect();
      sight.disconnect();
      plot.destroy();
    };
  }, [isDark, recording]);
  return (
    <div class="chart">
      <Newest line={line} session={session} recording={recording} />
      <div class="plot" ref={place} aria-hidden="true" />
    </div>
  );
}

/** The newest number and its range: what the chart shows, in words. */
function Newest({ line, session, recording }: Shown) {
  void session.ticks.value;
  const last = recording.last.value;
  const value = last?.[line.of] ?? null;
  const unit = line.unit(session.topology.value?.units);
  const [low, high] = recording.span(line.of);
  const stale = session.connection.value !== "live" || !session.frame;
  if (line.of === "total" && last?.total === null)
    return <p class="faint">{line.name}: undefined, as a force of this scene has no energy</p>;
  return (
    <p class={stale ? "stale" : ""}>
      <span>{line.name}</span>{" "}
      <output class="number" aria-live="off">
        {value === null ? "-" : measured(value, unit)}
      </output>
      {low < high && (
        <span class="faint between">
          {said(low, 3)} to {measured(Number(high.toPrecision(3)), unit)} in the last minute
        </span>
      )}
    </p>
  );
}

export const HEIGHT = 40;

export function plotted(line: { log?: boolean; whole?: boolean }, place: HTMLElement): uPlot {
  const { color, borderBottomColor } = getComputedStyle(place);
  return new uPlot(
    {
      width: Math.max(60, place.clientWidth),
      height: HEIGHT,
      padding: [4, 2, 4, 2],
      legend: { show: false },
      cursor: { show: false },
      scales: {
        x: { time: false, range: (_, first, last) => [line.whole ? first : last - 60, Math.max(last, first + 1e-3)] },
        y: line.log ? { distr: 3 } : { range: (_, low, high) => apart(low, high) },
      },
      axes: [
        { show: false },
        {
          show: true,
          size: 0,
          ticks: { show: false },
          grid: { stroke: borderBottomColor, width: 1 },
          values: () => [],
          gap: 0,
          space: 14,
          splits: (_, __, low, high) => (line.log ? decades(low, high) : [low, (low + high) / 2, high]),
        },
      ],
      series: [{}, { stroke: color, width: 1.5, points: { show: false } }],
    },
    [[], []],
    place,
  );
}

/** A range with distinct digits: numbers at rest differ by rounding alone. */
function apart(low: number, high: number): [number, number] {
  const least = 1e-6 * Math.max(Math.abs(low), Math.abs(high)) || 1;
  if (!Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
  return high - low < least ? [low - least, high + least] : [low, high];
}

/** Powers of ten between two numbers, five of them at most. */
function decades(low: number, high: number): number[] {
  if (!(low > 0 && high < Infinity)) return [];
  const [first, last] = [Math.ceil(Math.log10(low)), Math.floor(Math.log10(high))];
  const step = Math.max(1, Math.ceil((last - first) / 4));
  return Array.from({ length: Math.floor((last - first) / step) + 1 }, (_, i) => 10 ** (first + i * step));
}
