// A recording as a video: WebM by the browser's encoder, else pictures in a zip archive. Loaded when it is asked for.
import { ArrayBufferTarget, Muxer } from "webm-muxer";
import { zipSync } from "three/examples/jsm/libs/fflate.module.js";
import { extremes } from "../view/extremes";
import { sizes } from "../view/scaling";
import { caption } from "./drawing";
import type { Film } from "./film";
import type { Studio } from "./studio";
import { dark } from "./theme";

export interface Filmed {
  blob: Blob;
  ending: string;
  /** A sentence on it; "" for none. */
  note: string;
}

export interface Told {
  /** Which part of the work is done, from 0 to 1. */
  progress: (part: number) => void;
  signal: AbortSignal;
}

const CODECS = [
  { name: "V_VP9", codec: "vp09.00.40.08" },
  { name: "V_VP8", codec: "vp8" },
];
const LARGEST = 1920; // pixels of a side
const BITS = 0.12; // of a pixel of a picture: lines stay sharp
const QUEUE = 4;

interface Encoding {
  add(picture: OffscreenCanvas, number: number): Promise<void>;
  end(): Promise<Filmed>;
}

/** Play the recording picture by picture, and return it as a file. Rejects where it is cancelled. */
export async function filmed(studio: Studio, title: string, rate: number, told: Told): Promise<Filmed> {
  const { film, view, options } = studio;
  const [canvas, drawing] = [document.querySelector<HTMLCanvasElement>(".drawing > canvas"), view.value];
  if (!canvas || !drawing || !film.shots.length) throw new Error("Nothing is recorded; press Record, then Play.");
  const before = { shown: film.shown.peek(), scale: options.scale.peek() };
  options.scale.value = fixed(film, before.scale, options.colouring.peek() === "force");
  const sheet = sheetOf(canvas);
  const encoding = (await webm(sheet.width, sheet.height, rate)) ?? pictures(rate);
  const count = Math.max(1, Math.ceil(film.length * rate));
  try {
    for (let number = 0, shot = 0, drawn = -1; number < count; number++) {
      if (told.signal.aborted) throw new Error("Cancelled.");
      while (shot + 1 < film.shots.length && film.shots[shot + 1]!.at <= number / rate) shot += 1;
      if (shot !== drawn) {
        film.show(shot);
        drawing.render();
        const pen = sheet.getContext("2d")!;
        pen.resetTransform();
        pen.drawImage(canvas, 0, 0, sheet.width, sheet.height);
        const captions = { title, legend: drawing.legend.peek() ?? drawing.faces.peek(), arrows: [] };
        caption(pen, captions, dark.peek(), sheet.width / canvas.clientWidth);
        drawn = shot;
      }
      await encoding.add(sheet, number);
      told.progress((number + 1) / count);
    }
    return await encoding.end();
  } finally {
    options.scale.value = before.scale;
    if (before.shown === null) film.leave();
    else film.show(before.shown);
  }
}

/** As large as the canvas, in even numbers of pixels, which encoders need. */
function sheetOf({ width, height }: HTMLCanvasElement): OffscreenCanvas {
  const part = Math.min(1, LARGEST / Math.max(width, height));
  const even = (size: number) => Math.max(2, 2 * Math.floor((size * part) / 2));
  return new OffscreenCanvas(even(width), even(height));
}

/** One scale for all pictures: the extremes of the whole recording, where no ends are typed. */
function fixed(film: Film, scale: Studio["options"]["scale"]["value"], isForce: boolean) {
  if (!isForce) return scale;
  const shown = (forces: Float32Array) => (scale.kind === "log" ? sizes(forces) : forces);
  const ends = film.shots.map(({ frame }) => extremes(shown(frame.springForces))).filter(([low]) => !Number.isNaN(low));
  if (!ends.length) return scale;
  const [low, high] = [Math.min(...ends.map(([low]) => low)), Math.max(...ends.map(([, high]) => high))];
  return high > low ? { ...scale, low: scale.low ?? low, high: scale.high ?? high } : scale;
}

/** An encoder of this browser; null for none. */
async function webm(width: number, height: number, rate: number): Promise<Encoding | null> {
  if (typeof VideoEncoder === "undefined") return null;
  for (const { name, codec } of CODECS) {
    const bitrate = Math.round(BITS * width * height * rate);
    const config = { codec, width, height, framerate: rate, bitrate };
    const { supported } = await VideoEncoder.isConfigSupported(config).catch(() => ({ supported: false }));
    if (supported) return encoded(name, config, rate);
  }
  return null;
}

function encoded(name: string, config: VideoEncoderConfig, rate: number): Encoding {
  const target = new ArrayBufferTarget();
  const { width, height } = config;
  const muxer = new Muxer({ target, video: { codec: name, width, height, frameRate: rate } });
  let fault: Error | null = null;
  const encoder = new VideoEncoder({
    output: (chunk, meta) => muxer.addVideoChunk(chunk, meta),
    error: (error) => (fault = error),
  });
  encoder.configure(config);
  return {
    async add(picture, number) {
      while (encoder.encodeQueueSize > QUEUE && !fault)
        await new Promise((resolve) => encoder.addEventListener("dequeue", resolve, { once: true }));
      if (fault) throw fault;
      const timestamp = Math.round((1e6 * number) / rate);
      const frame = new VideoFrame(picture, { timestamp, duration: Math.round(1e6 / rate) });
      encoder.encode(frame, { keyFrame: number % (2 * rate) === 0 });
      frame.close();
      await new Promise((resolve) => setTimeout(resolve)); // the page stays responsive
    },
    async end() {
      await encoder.flush();
      encoder.close();
      muxer.finalize();
      return { blob: new Blob([target.buffer], { type: "video/webm" }), ending: ".webm", note: "" };
    },
  };
}

function pictures(rate: number): Encoding {
  const files: Record<string, Uint8Array> = {};
  return {
    async add(picture, number) {
      const png = await picture.convertToBlob({ type: "image/png" });
      files[`${String(number).padStart(5, "0")}.png`] = new Uint8Array(await png.arrayBuffer());
    },
    async end() {
      const note = ` This browser writes no video: the archive has a picture for each frame, ${rate} a second.`;
      const zip = zipSync(files, { level: 0 }) as Uint8Array<ArrayBuffer>;
      return { blob: new Blob([zip], { type: "application/zip" }), ending: "-frames.zip", note };
    },
  };
}
