// A session as this page watches it: its frames, how it stands, and edits with their answers. It comes back by itself.
import { batch, signal } from "@preact/signals";
import * as api from "./api";
import { decode, type Frame } from "./frame";
import { guest, READ_ONLY, spoken } from "./guest";
import type { Action, Anchor, Patch, Scene, Summary, Topology } from "./model";
import { note, stats } from "./stats";

/** connecting: the first time; live: numbers are of now; silent: connected, it plays or an order waits, nothing comes;
 * lost: it is tried again; locked: no cookie; gone: forgotten by the service; broken: no frame that can be read. */
export type Connection = "connecting" | "live" | "silent" | "lost" | "locked" | "gone" | "broken";

const FIRST_WAIT = 250;
const LONGEST_WAIT = 4000;
const SILENCE = 2000;
/** Characters of a message over the socket; longer edits go by HTTP. */
const LONGEST_MESSAGE = 48_000;

interface Waiting {
  /** When it was sent [ms]. */
  asked: number;
  resolve: (summary: Summary) => void;
  reject: (error: Error) => void;
}

type Part = "topology" | "scene" | "anchors";

type Order = { edit: Patch } | { do: Action; frames?: number };

export class Session {
  readonly connection = signal<Connection>("connecting");
  readonly summary = signal<Summary | null>(null);
  readonly topology = signal<Topology | null>(null);
  /** As of the last revision that was read. */
  readonly anchors = signal<Anchor[]>([]);
  readonly scene = signal<Scene | null>(null);
  /** The scene is of this revision or a later one; -1 before it is read. */
  readonly read = signal(-1);
  /** Counts changes of the colours that programs give. */
  readonly views = signal(0);
  /** What went wrong last, in a sentence; "" for nothing. */
  readonly said = signal("");
  /** Counts frames: what shows numbers of the frame reads it, at most ten times a second. */
  readonly ticks = signal(0);
  /** The newest frame; null until the first, and while another scene is read. */
  frame: Frame | null = null;
  /** The last one of this connection, to which the next one may be told by its changes. */
  private before: Frame | null = null;

  private socket: WebSocket | null = null;
  private readonly waiting = new Map<number, Waiting>();
  private readonly watchers = new Set<(frame: Frame) => void>();
  private orders = 0;
  /** When the last order is answered or refused. */
  private last: Promise<unknown> = Promise.resolve();
  private pauses = 0;
  private pausing = 0; // those that are not answered yet
  private tag: string | null = null;
  private acknowledged = 0;
  private told = -1; // the revision of the last summary: frames may be newer
  private wait = FIRST_WAIT;
  private heard = 0;
  private ticked = 0;
  /** Of what topology, scene and anchors were read. */
  private described: Record<Part, string> = { topology: "", scene: "", anchors: "" };
  private describing = false;
  /** Particles that the anchors hold, and hands that lead one. */
  private held = 0;
  private hands = 0;
  private unacknowledged: number[] = [];
  private timers: number[] = [];
  private retry = 0;
  private closed = false;

  constructor(readonly key: string) {
    this.timers.push(window.setInterval(() => this.listen(), 500));
    document.addEventListener("visibilitychange", this.seen);
    this.connect();
  }

  /** The newest revision that an order of this page was answered with. */
  get answered(): number {
    return this.acknowledged;
  }

  /** When the oldest order that waits for its answer was sent [ms]; Infinity where none waits. */
  get asked(): number {
    const [oldest] = this.waiting.values();
    return oldest?.asked ?? Infinity;
  }

  /** Called with every frame that may be shown; returns how to stop it. */
  onFrame(watcher: (frame: Frame) => void): () => void {
    this.watchers.add(watcher);
    if (this.frame) watcher(this.frame);
    return () => this.watchers.delete(watcher);
  }

  /** Make an edit. A form at rest goes on, one that was paused by hand stays paused. Rejects with Refused. */
  edit(patch: Patch): Promise<Summary> {
    return this.change({ edit: patch });
  }

  /** Play, relax, pause, step, reset, undo or redo. Rejects with Refused. */
  async act(action: Action, options: { frames?: number } = {}): Promise<Summary> {
    const order = { do: action, ...options };
    if (action === "undo" || action === "redo") return this.change(order);
    if (action !== "pause" && action !== "step") return this.order(order);
    this.pauses += 1;
    this.pausing += 1;
    // a process that hangs on an order never comes to the next one of this connection
    const byItself = action === "pause" && this.connection.value === "silent" && !this.readOnly;
    return (byItself ? this.paused() : this.order(order)).finally(() => (this.pausing -= 1));
  }

  /** Edit or act for a control: refusals are shown instead of thrown. */
  async tell(what: Patch | Action, options: { frames?: number } = {}): Promise<boolean> {
    try {
      await (typeof what === "string" ? this.act(what, options) : this.edit(what));
      this.said.value = "";
      return true;
    } catch (error) {
      this.said.value = error instanceof Error ? error.message : String(error);
      return false;
    }
  }

  /** Give it another name. */
  async rename(label: string): Promise<void> {
    const { label: name } = await api.rename(this.key, label);
    const now = this.summary.value;
    if (now) this.summary.value = { ...now, label: name };
  }

  /** A hand begins to lead a particle; returns how it ends. What it does to the anchors is read at the end. */
  lead(): () => void {
    let leads = true;
    this.hands += 1;
    return () => {
      if (!leads) return;
      leads = false;
      this.hands -= 1;
      void this.describe();
    };
  }

  /** The anchors after every order that was given, which `anchors` may not have yet; those if they cannot be read. */
  async anchorsOfNow(): Promise<Anchor[]> {
    await this.last;
    const isRead = this.described.anchors === this.stand().anchors;
    return isRead ? this.anchors.value : api.anchors(this.key).catch(() => this.anchors.value);
  }

  /** Whether this page was opened by a read-only link. */
  readonly readOnly = guest !== "";

  /** Whether a hand leads a particle. */
  get isLed(): boolean {
    return this.hands > 0;
  }

  /** Stop watching. The session goes on. */
  close(): void {
    this.closed = true;
    this.timers.forEach(clearInterval);
    clearTimeout(this.retry);
    document.removeEventListener("visibilitychange", this.seen);
    this.socket?.close();
    this.lose("This page has left the session.");
    this.watchers.clear();
  }

  /** Change the form, and go on if it did, unless a hand stops it meanwhile. */
  private async change(order: Order): Promise<Summary> {
    const goes = this.goes();
    const pauses = this.pauses;
    const made = await this.order(order);
    return goes && !made.playing && pauses === this.pauses ? this.order({ do: "play" }) : made;
  }

  /** Whether it goes on, or has come to its end: all but what a hand has paused, or is about to. */
  private goes(): boolean {
    const now = this.summary.value;
    return now !== null && !this.pausing && (now.playing || now.status !== "running");
  }

  private connect(): void {
    const address = `ws://${location.host}/v1/sessions/${encodeURIComponent(this.key)}/frames`;
    const socket = new WebSocket(`${address}?changes=true`, spoken());
    socket.binaryType = "arraybuffer";
    this.before = null;
    socket.onmessage = (event) => this.take(event.data as string | ArrayBuffer);
    socket.onclose = (event) => void this.closing(socket, event);
    this.socket = socket;
  }

  private take(data: string | ArrayBuffer): void {
    this.heard = performance.now();
    if (this.connection.value === "silent") this.connection.value = "live";
    if (typeof data !== "string") return this.framed(data);
    const message = JSON.parse(data) as Record<string, unknown>;
    if ("view" in message) this.views.value = message["view"] as number;
    if ("hello" in message) this.greeted(message["session"] as Summary, message["topology"] as string);
    else if ("state" in message) this.stands(message["state"] as Summary, message["topology"] as string);
    else this.reply(message);
  }

  private greeted(summary: Summary, tag: string): void {
    // numbers of frames and revisions begin again with the connection: the service may be another one
    this.acknowledged = stats.revisionAcknowledged = 0;
    this.described = { ...this.described, scene: "", anchors: "" };
    this.read.value = -1;
    if (tag !== this.tag) this.frame = null;
    this.wait = FIRST_WAIT;
    batch(() => {
      this.connection.value = "live";
      this.stands(summary, tag);
    });
  }

  private stands(summary: Summary, tag: string): void {
    this.summary.value = summary;
    this.told = summary.revision;
    if (tag && tag !== this.tag) {
      this.tag = tag;
      // a frame may come before the state with its scene
      if (this.frame && this.frame.revision < summary.revision) this.frame = null;
    }
    void this.describe();
  }

  /** Read what goes by HTTP, as far as it is not that of now. One reading at a time. */
  private async describe(): Promise<void> {
    const now = this.stand();
    const { described: before } = this;
    const isOther = (part: Part) => now[part] !== before[part];
    if (this.describing) return;
    const revision = this.told;
    if (!(isOther("topology") || isOther("scene") || (isOther("anchors") && this.isAsked()))) {
      this.read.value = revision;
      return;
    }
    this.describing = true;
    try {
      const [topology, anchors, scene] = await Promise.all([
        isOther("topology") ? api.topology(this.key) : this.topology.value,
        isOther("anchors") ? api.anchors(this.key) : this.anchors.value,
        isOther("scene") ? api.scene(this.key) : this.scene.value,
      ]);
      batch(() => {
        this.described = now;
        this.topology.value = topology;
        this.anchors.value = anchors;
        this.scene.value = scene;
        this.held = heldOf(anchors);
        this.read.value = revision;
      });
      if (this.frame) this.show(this.frame);
    } catch {
      // the connection shows what is wrong; the next state or tick asks again
    } finally {
      this.describing = false;
    }
  }

  /** Stands for topology, scene and anchors of now. */
  private stand(): Record<Part, string> {
    const { revision = 0, scene_revision = revision, anchors_revision = revision } = this.summary.value ?? {};
    const tag = this.tag ?? "";
    return { topology: tag, scene: `${tag} ${scene_revision}`, anchors: `${tag} ${anchors_revision}` };
  }

  /** Whether anchors are to be read: while a hand leads one, only where others hold than before. */
  private isAsked(): boolean {
    return !this.hands || (this.frame !== null && this.frame.reactions.length !== 3 * this.held);
  }

  private framed(data: ArrayBuffer): void {
    const began = performance.now();
    let frame: Frame;
    try {
      frame = this.before = decode(data, this.before);
    } catch (error) {
      this.said.value = error instanceof Error ? error.message : String(error);
      this.connection.value = "broken";
      this.socket?.close();
      this.lose(this.said.value);
      return;
    }
    note(stats.decodeMilliseconds, performance.now() - began);
    stats.framesReceived += 1;
    this.unacknowledged.push(frame.number);
    if (!document.hidden) this.seen();
    if (frame.revision < this.acknowledged) stats.framesLeftOut += 1;
    else this.show(frame);
    if (this.hands) void this.describe();
  }

  private show(frame: Frame): void {
    this.frame = frame;
    const topology = this.topology.value;
    const fits =
      topology?.particles === frame.positions.length / 3 && topology.springs.length === frame.springForces.length;
    if (!fits || this.described.topology !== this.tag) return;
    this.watchers.forEach((watcher) => watcher(frame));
    if (performance.now() - this.ticked > 100) this.tick();
  }

  private tick(): void {
    this.ticked = performance.now();
    this.ticks.value += 1;
  }

  private readonly seen = (): void => {
    const last = this.unacknowledged.at(-1);
    if (document.hidden || last === undefined || this.socket?.readyState !== WebSocket.OPEN) return;
    this.unacknowledged = [];
    this.socket.send(JSON.stringify({ ack: last }));
  };

  private order(order: Order): Promise<Summary> {
    const made = this.send(order);
    this.last = made.catch(() => null);
    return made;
  }

  private send(order: Order): Promise<Summary> {
    if (this.readOnly) return Promise.reject(new api.Refused(403, READ_ONLY, "read-only"));
    return new Promise((resolve, reject) => {
      if (this.socket?.readyState !== WebSocket.OPEN) {
        const broken = this.connection.value === "broken" && this.said.value;
        reject(new api.Refused(0, broken || "Not done: no connection to the service.", "unreachable"));
        return;
      }
      const id = ++this.orders;
      const message = JSON.stringify({ id, ...order });
      if ("edit" in order && message.length > LONGEST_MESSAGE) {
        api.edit(this.key, order.edit).then((made) => resolve(this.acknowledge(this.newer(made))), reject);
        return;
      }
      this.waiting.set(id, { asked: performance.now(), resolve, reject });
      this.socket.send(message);
    });
  }

  /** Pause by another connection than that of the orders. */
  private async paused(): Promise<Summary> {
    return this.acknowledge(this.newer((await (await api.act(this.key, "pause")).json()) as Summary));
  }

  /** How the session stands: a state on the socket may have been faster than the answer to a request. */
  private newer(made: Summary): Summary {
    const now = this.summary.value;
    return now && now.revision > made.revision ? now : made;
  }

  private reply(message: Record<string, unknown>): void {
    const waiting = this.waiting.get(message["id"] as number);
    this.waiting.delete(message["id"] as number);
    if ("problem" in message) {
      const problem = message["problem"] as Record<string, unknown>;
      waiting?.reject(api.refusal(Number(problem["status"] ?? 400), problem));
      return;
    }
    waiting?.resolve(this.acknowledge(message["session"] as Summary));
  }

  /** How the session stands after an order of this page: what is older is not shown any more. */
  private acknowledge(summary: Summary): Summary {
    if (this.closed) return summary; // the counts are those of the next session by now
    this.acknowledged = Math.max(this.acknowledged, summary.revision);
    stats.revisionAcknowledged = this.acknowledged;
    if (this.frame && this.frame.revision < this.acknowledged) this.frame = null;
    this.summary.value = summary;
    this.told = summary.revision;
    return summary;
  }

  private async closing(socket: WebSocket, event: CloseEvent): Promise<void> {
    if (socket !== this.socket || this.closed || this.connection.value === "broken") return;
    this.unacknowledged = [];
    this.lose("The connection was lost before the service answered; this may or may not have been done.");
    this.connection.value = event.code === 4404 ? "gone" : "lost";
    if (event.code === 4404) return this.again(LONGEST_WAIT); // a program may make one with its key again
    if (event.code === 4429) this.said.value = event.reason;
    const found = await api.summary(this.key).then(() => 200, (error: api.Refused) => error.status);
    if (this.closed) return;
    if (found === 401 || found === 403) this.connection.value = "locked";
    else {
      if (found === 404) this.connection.value = "gone";
      this.again(found === 404 ? LONGEST_WAIT : this.wait);
    }
    this.wait = Math.min(2 * this.wait, LONGEST_WAIT);
  }

  private again(wait: number): void {
    this.retry = window.setTimeout(() => this.connect(), wait);
  }

  private lose(sentence: string): void {
    const error = new api.Refused(0, sentence, "unreachable");
    this.waiting.forEach((waiting) => waiting.reject(error));
    this.waiting.clear();
  }

  /** Twice a second: whether frames still come, and the last one's numbers. */
  private listen(): void {
    const since = Math.max(this.heard, this.summary.value?.playing ? 0 : this.asked);
    if (this.connection.value === "live" && performance.now() - since > SILENCE) this.connection.value = "silent";
    if (this.connection.value !== "live") return;
    this.tick();
    const frame = this.frame;
    const summary = this.summary.value;
    if (frame && summary && frame.revision > summary.revision)
      this.summary.value = { ...summary, revision: frame.revision };
    if (!this.waiting.size) void this.describe();
  }
}

/** How many particles anchors hold. */
const heldOf = (anchors: Anchor[]) =>
  new Set(anchors.flatMap(({ axes, particles }) => (axes ? particles : []))).size;
