// The canvas: what is drawn on it, how finely, and how it is taken away as a picture.
import {
  BufferAttribute,
  BufferGeometry,
  type Camera,
  Group,
  LinearSRGBColorSpace,
  LineSegments,
  Mesh,
  Plane,
  Points,
  RawShaderMaterial,
  Scene,
  Texture,
  WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { type Common, common } from "./material";

const SAMPLES = 4;
/** How finely it is drawn while something moves: pixels for each CSS pixel at most, and whether edges are smoothed. */
const LEVELS = [
  { ratio: 2, smooth: true },
  { ratio: 1, smooth: false },
  { ratio: 0.7, smooth: false },
  { ratio: 0.5, smooth: false },
];
const SLOW = 36;
const QUICK = 20;
const NO_PLANE = new Plane();

/** Chooses how finely to draw while something moves, from how long pictures take. */
export class Pace {
  /** By the last picture [ms]. */
  taken = 0;
  private level = 0;
  private slow = 0;
  private quick = 0;
  private patience = 120;

  /** Note how long a picture took [ms]. */
  note(taken: number): void {
    this.taken = taken;
    this.slow = taken > SLOW ? this.slow + 1 : 0;
    this.quick = taken < QUICK ? this.quick + 1 : 0;
    if (this.slow > 1 && this.level < LEVELS.length - 1) {
      this.level += 1;
      this.slow = 0;
    } else if (this.quick > this.patience && this.level > 0) {
      this.level -= 1;
      this.quick = 0;
      this.patience *= 2; // so that it does not go to and fro
    }
  }

  /** Whether this machine draws so slowly that every line counts. */
  get rough(): boolean {
    return this.level > 1;
  }

  get fineness(): { ratio: number; smooth: boolean } {
    return LEVELS[this.level]!;
  }
}

export class Stage {
  readonly renderer: WebGLRenderer;
  readonly scene = new Scene();
  /** Around the middle of the form. */
  readonly group = new Group();
  readonly common: Common = common();
  readonly pace = new Pace();
  /** Beyond this plane nothing of the form is drawn; null: all of it is. */
  section: Plane | null = null;
  /** [CSS pixels] */
  width = 1;
  height = 1;
  private target: WebGLRenderTarget | null = null;
  private readonly sheet: Mesh<BufferGeometry, RawShaderMaterial>;

  /** An Error says in a sentence why nothing can be drawn. */
  constructor(canvas: HTMLCanvasElement) {
    try {
      this.renderer = new WebGLRenderer({
        canvas,
        antialias: false,
        alpha: false,
        powerPreference: "high-performance",
      });
    } catch {
      throw new Error(
        "This browser does not support WebGL 2: allow hardware acceleration, or use another browser.",
      );
    }
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.scene.add(this.group);
    this.sheet = sheet();
  }

  /** The size of the canvas [CSS pixels]; it takes effect with the next picture. */
  resize(width: number, height: number): void {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
  }

  /** Draw; finely, or as finely as its pace allows. */
  draw(camera: Camera, finely: boolean): void {
    const most = Math.min(devicePixelRatio, 2);
    const { ratio, smooth } = finely ? { ratio: 2, smooth: true } : this.pace.fineness;
    const { renderer } = this;
    const wanted = Math.min(ratio, most);
    if (renderer.getPixelRatio() !== wanted) renderer.setPixelRatio(wanted);
    const canvas = renderer.domElement;
    const [columns, rows] = [Math.floor(this.width * wanted), Math.floor(this.height * wanted)];
    if (canvas.width !== columns || canvas.height !== rows) renderer.setSize(this.width, this.height, false);
    this.common.size.value.set(this.width, this.height);
    this.common.ratio.value = wanted;
    this.cut(camera);
    if (!smooth) {
      renderer.render(this.scene, camera);
      return;
    }
    const target = this.smoothed(columns, rows);
    this.into(target, camera);
    this.sheet.material.uniforms["picture"]!.value = target.texture;
    renderer.render(this.sheet, camera);
  }

  /** What is seen, smoothed, at no less than two pixels for each CSS pixel. */
  async png(camera: Camera): Promise<Blob> {
    const ratio = Math.max(2, devicePixelRatio);
    const [columns, rows] = [Math.round(this.width * ratio), Math.round(this.height * ratio)];
    const target = new WebGLRenderTarget(columns, rows, { samples: SAMPLES });
    this.common.size.value.set(this.width, this.height);
    this.common.ratio.value = ratio;
    this.cut(camera);
    this.into(target, camera);
    const pixels = new Uint8ClampedArray(4 * columns * rows);
    this.renderer.readRenderTargetPixels(target, 0, 0, columns, rows, pixels);
    target.dispose();
    return encoded(pixels, columns, rows);
  }

  dispose(): void {
    this.target?.dispose();
    this.sheet.geometry.dispose();
    this.sheet.material.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  /** The graphics card has lost everything: what stands for things on it is dropped, and made again when drawn. */
  forget(): void {
    this.target?.dispose();
    this.target = null;
    for (const root of [this.scene, this.sheet]) {
      root.traverse((object) => {
        if (!(object instanceof Mesh || object instanceof Points || object instanceof LineSegments)) return;
        const { geometry, material } = object as Mesh<BufferGeometry, RawShaderMaterial>;
        geometry.dispose();
        material.dispose();
        for (const { value } of Object.values(material.uniforms)) if (value instanceof Texture) value.dispose();
      });
    }
  }

  private cut(camera: Camera): void {
    camera.updateMatrixWorld();
    const { normal, constant } = new Plane().copy(this.section ?? NO_PLANE).applyMatrix4(camera.matrixWorldInverse);
    if (this.section) this.common.cut.value.set(normal.x, normal.y, normal.z, constant);
    else this.common.cut.value.set(0, 0, 0, 0);
  }

  private into(target: WebGLRenderTarget, camera: Camera): void {
    this.renderer.setRenderTarget(target);
    this.renderer.render(this.scene, camera);
    this.renderer.setRenderTarget(null);
  }

  private smoothed(columns: number, rows: number): WebGLRenderTarget {
    if (this.target?.width === columns && this.target.height === rows) return this.target;
    this.target?.dispose();
    return (this.target = new WebGLRenderTarget(columns, rows, { samples: SAMPLES }));
  }
}

/** One triangle over the whole canvas that shows a picture. */
function sheet(): Mesh<BufferGeometry, RawShaderMaterial> {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
  const made = new Mesh(
    geometry,
    new RawShaderMaterial({
      uniforms: { picture: { value: null } },
      vertexShader: `attribute vec3 position; varying vec2 at;
        void main() { at = position.xy * 0.5 + 0.5; gl_Position = vec4(position, 1.0); }`,
      fragmentShader: `precision highp float; uniform sampler2D picture; varying vec2 at;
        void main() { gl_FragColor = texture2D(picture, at); }`,
      depthTest: false,
      depthWrite: false,
    }),
  );
  made.frustumCulled = false;
  return made;
}

async function encoded(pixels: Uint8ClampedArray<ArrayBuffer>, columns: number, rows: number): Promise<Blob> {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [columns, rows];
  const image = new ImageData(columns, rows);
  // the lowest row comes first from the card
  for (let row = 0; row < rows; row++) {
    const from = 4 * columns * (rows - 1 - row);
    image.data.set(pixels.subarray(from, from + 4 * columns), 4 * columns * row);
  }
  canvas.getContext("2d")!.putImageData(image, 0, 0);
  return new Promise((resolve, reject) => {
    canvas.toBlob((blob) =>
      blob ? resolve(blob) : reject(new Error("The picture could not be written; try a smaller window.")),
    );
  });
}
