// A variant on a canvas of its own, which is looked at from where the form is: the cameras are linked.
import { effect } from "@preact/signals";
import type { Frame } from "../frame";
import { still, type Variant } from "../variants";
import { acting } from "./acting";
import { Eye } from "./camera";
import { form } from "./form";
import { Picture } from "./picture";
import { Stage } from "./stage";
import type { Options, View } from "./types";

const REST = 220;

/** Draw a variant on `canvas` as `view` is seen; returns how to end that. */
export function drawBeside(canvas: HTMLCanvasElement, variant: Variant, view: View, options: Options): () => void {
  const drawn = new Beside(canvas, variant, view, options);
  return () => drawn.dispose();
}

class Beside {
  private readonly stage: Stage;
  private readonly eye: Eye;
  private readonly picture: Picture;
  private readonly frame: Frame;
  private readonly undo: (() => void)[] = [];
  private follows = false;
  private asked = 0;
  private rest = 0;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly variant: Variant,
    private readonly view: View,
    options: Options,
  ) {
    this.stage = new Stage(canvas);
    this.eye = new Eye(canvas, this.moved);
    this.picture = new Picture(this.stage);
    this.frame = still(variant);
    this.build();
    const observer = new ResizeObserver(() => this.resize());
    observer.observe(canvas);
    const listeners = new AbortController();
    const { signal } = listeners;
    canvas.addEventListener("webglcontextlost", () => this.stage.forget(), { signal });
    canvas.addEventListener("webglcontextrestored", () => this.build(), { signal });
    this.undo.push(
      () => observer.disconnect(),
      () => listeners.abort(),
      view.onMoved(this.follow),
      effect(() => {
        for (const option of [options.layers, options.dark, options.colouring, view.legend]) void option.value;
        this.ask();
      }),
    );
    this.resize();
    this.follow();
  }

  dispose(): void {
    cancelAnimationFrame(this.asked);
    clearTimeout(this.rest);
    this.undo.reverse().forEach((undo) => undo());
    this.eye.dispose();
    this.picture.dispose();
    this.stage.dispose();
  }

  private build(): void {
    const { picture, variant, frame } = this;
    picture.build(form(variant.topology));
    picture.bear(acting(variant.topology, variant.scene));
    picture.hold(variant.anchors);
    picture.put(frame);
    picture.survey(frame);
    this.ask();
  }

  private resize(): void {
    this.stage.resize(this.canvas.clientWidth, this.canvas.clientHeight);
    this.eye.shape(this.stage.width, this.stage.height);
    this.ask();
  }

  /** As the form is looked at. */
  private readonly follow = (): void => {
    if (this.follows) return;
    this.follows = true;
    this.eye.put(this.view.place());
    this.follows = false;
  };

  private readonly moved = (): void => {
    if (!this.follows) {
      this.follows = true;
      this.view.put(this.eye.place);
      this.follows = false;
    }
    this.ask();
  };

  private ask(): void {
    this.asked ||= requestAnimationFrame(() => {
      this.asked = 0;
      this.draw(false);
      clearTimeout(this.rest);
      this.rest = window.setTimeout(() => this.draw(true), REST);
    });
  }

  private draw(finely: boolean): void {
    const { picture, stage, eye, view } = this;
    if (stage.renderer.getContext().isContextLost()) return;
    const dress = view.dressing();
    picture.dress({ ...dress, colouring: dress.colouring === "force" ? "force" : "plain" });
    eye.reach(stage.common.centre.value, picture.size * 2);
    stage.draw(eye.camera, finely);
  }
}
