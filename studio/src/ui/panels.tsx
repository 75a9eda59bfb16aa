// What is beside the canvas.
import type { Studio } from "./studio";

export function Panels({ studio: _studio, title: _title }: { studio: Studio; title: string }) {
  return <aside class="panels" aria-label="Panels" />;
}
