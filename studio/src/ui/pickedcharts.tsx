// Charts of what is picked: position and reaction of a particle, force and length of a spring.
import { useEffect, useRef } from "preact/hooks";
import type uPlot from "uplot";
import { HEIGHT, plotted } from "./charts";
import { keep } from "./out";
import type { Studio } from "./studio";
import { dark } from "./theme";
import type { Line } from "./traced";
import { measured, said, titled } from "./words";

export function PickedCharts({ studio }: { studio: Studio }) {
  const picked = studio.options.picked.value;
  const traced = studio.traced.lines();
  if (!picked || !traced) return <p class="faint">Pick a particle or a spring to chart it, too.</p>;
  const { recorded, times, lines } = traced;
  const title = `${titled(picked.kind)} ${picked.index}`;
  const save = () => keep(new Blob([csv(times, lines)], { type: "text/csv" }), `${title.replace(" ", "-")}.csv`);
  return (
    <section class="picked-charts" aria-label={`Charts of ${title.toLowerCase()}`}>
      <p>
        <strong>{title}</strong> <span class="faint">{recorded ? "in the recording" : "in the last minute"}</span>
      </p>
      {lines.map((line) => (
        <Chart key={`${picked.kind} ${line.name}`} line={line} times={times} whole={recorded} />
      ))}
      <button
        type="button"
        class="small"
        disabled={!times.length}
        title="Save these numbers as a CSV file"
        onClick={save}
      >
        Save charts
      </button>
    </section>
  );
}

interface OfChart {
  line: Line;
  times: number[];
  whole: boolean;
}

function Chart({ line, times, whole }: OfChart) {
  const place = useRef<HTMLDivElement>(null);
  const plot = useRef<uPlot | null>(null);
  const isDark = dark.value;
  useEffect(() => {
    const box = place.current;
    if (!box) return;
    const made = (plot.current = plotted({ whole }, box));
    const sizes = new ResizeObserver(([entry]) => {
      const width = Math.floor(entry?.contentRect.width ?? 0);
      if (width > 0 && width !== made.width) made.setSize({ width, height: HEIGHT });
    });
    sizes.observe(box);
    return () => {
      sizes.disconnect();
      made.destroy();
      plot.current = null;
    };
  }, [isDark, whole]);
  useEffect(() => {
    if (place.current?.checkVisibility({ contentVisibilityAuto: true })) plot.current?.setData([times, line.values]);
  });
  const known = line.values.filter((value) => value !== null);
  const [low, high] = [Math.min(...known), Math.max(...known)];
  const newest = known.at(-1);
  return (
    <div class="chart">
      <p>
        <span>{line.name}</span>{" "}
        <output class="number" aria-live="off">
          {newest === undefined ? "-" : measured(newest, line.unit)}
        </output>
        {low < high && (
          <span class="faint between">
            {said(low, 3)} to {measured(Number(high.toPrecision(3)), line.unit)}
          </span>
        )}
      </p>
      <div class="plot" ref={place} aria-hidden="true" />
    </div>
  );
}

function csv(times: number[], lines: Line[]): string {
  const head = ["time [s]", ...lines.map(({ name, unit }) => `${name} [${unit}]`)];
  const first = times[0] ?? 0;
  const rows = times.map((at, i) => [at - first, ...lines.map(({ values }) => values[i] ?? "")].join());
  return [head.join(), ...rows, ""].join("\r\n");
}
