// Numbers on the graphics card: a column for what changes with each frame, read by shaders by its row.
import {
  DataTexture,
  FloatType,
  IntType,
  NearestFilter,
  type PixelFormat,
  RedFormat,
  RedIntegerFormat,
  RGBFormat,
  RGIntegerFormat,
  type WebGLRenderer,
} from "three";

/** Rows side by side in a texture; a power of two. */
export const WIDTH = 1024;

/** Rows of one or three float32 in a texture. */
export class Column {
  readonly texture: DataTexture;
  private readonly format: PixelFormat;
  private shown: Float32Array | null = null;

  constructor(
    readonly rows: number,
    private readonly components: 1 | 3,
  ) {
    this.format = components === 1 ? RedFormat : RGBFormat;
    this.texture = new DataTexture(null, WIDTH, Math.max(1, Math.ceil(rows / WIDTH)), this.format, FloatType);
    this.texture.internalFormat = components === 1 ? "R32F" : "RGB32F";
    this.texture.minFilter = this.texture.magFilter = NearestFilter;
    this.texture.source.dataReady = false; // room alone: `put` fills it
    this.texture.needsUpdate = true;
  }

  /** Hand rows to the card at once, straight from `values`, unless it has these already. */
  put(renderer: WebGLRenderer, values: Float32Array): void {
    if (values === this.shown) return;
    this.shown = values;
    const gl = renderer.getContext() as WebGL2RenderingContext;
    renderer.initTexture(this.texture);
    const found = renderer.properties.get(this.texture) as { __webglTexture: WebGLTexture };
    renderer.state.bindTexture(gl.TEXTURE_2D, found.__webglTexture);
    const format = this.components === 1 ? gl.RED : gl.RGB;
    const rows = Math.min(this.rows, values.length / this.components);
    const whole = Math.floor(rows / WIDTH);
    const rest = rows - whole * WIDTH;
    if (whole) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, WIDTH, whole, format, gl.FLOAT, values, 0);
    if (rest)
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, whole, rest, 1, format, gl.FLOAT, values, whole * WIDTH * this.components);
    renderer.state.unbindTexture();
  }

  dispose(): void {
    this.texture.dispose();
  }
}

/** Rows of one or two whole numbers that stay: which particles something joins. */
export class Rows {
  readonly texture: DataTexture;
  readonly count: number;
  private readonly values: Int32Array;

  constructor(values: Int32Array, components: 1 | 2) {
    this.count = values.length / components;
    const height = Math.max(1, Math.ceil(this.count / WIDTH));
    this.values = new Int32Array(components * WIDTH * height);
    this.values.set(values);
    const format = components === 1 ? RedIntegerFormat : RGIntegerFormat;
    this.texture = new DataTexture(this.values, WIDTH, height, format, IntType);
    this.texture.internalFormat = components === 1 ? "R32I" : "RG32I";
    this.texture.needsUpdate = true;
  }

  /** Other numbers in the first rows. */
  put(values: ArrayLike<number>): void {
    this.values.set(values);
    this.texture.needsUpdate = true;
  }

  dispose(): void {
    this.texture.dispose();
  }
}
