/** What was measured on this page, for those who watch it: tests, and the panel of figures. */
export interface Stats {
  framesReceived: number;
  framesDrawn: number;
  /** Frames older than an acknowledged edit: received and left out. */
  framesLeftOut: number;
  /** Frames older than the last acknowledged edit that were drawn all the same: must stay 0. */
  staleFramesDrawn: number;
  /** On the main thread, of the last frames [ms]: reading a frame, its scale, colours and sizes, and handing it to the
   * graphics card. */
  decodeMilliseconds: number[];
  colourMilliseconds: number[];
  uploadMilliseconds: number[];
  revisionAcknowledged: number;
  revisionDrawn: number;
}

const KEPT = 600;

export const stats: Stats = {
  framesReceived: 0,
  framesDrawn: 0,
  framesLeftOut: 0,
  staleFramesDrawn: 0,
  decodeMilliseconds: [],
  colourMilliseconds: [],
  uploadMilliseconds: [],
  revisionAcknowledged: 0,
  revisionDrawn: 0,
};

/** Add a measurement; only the last ones are kept. */
export function note(list: number[], value: number): void {
  list.push(value);
  if (list.length > KEPT) list.splice(0, list.length - KEPT);
}
