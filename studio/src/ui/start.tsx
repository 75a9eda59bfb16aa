// The start page: figures to begin with, sessions that are there, files to open.
import { useEffect } from "preact/hooks";
import { Gallery } from "./gallery";
import { FileButton } from "./opening";
import { arrive } from "./place";
import { Running } from "./running";
import { ThemeChoice } from "./themechoice";

export function Start() {
  useEffect(() => {
    document.title = "hookean studio";
    arrive();
  }, []);
  return (
    <>
      <header class="top">
        <h1>hookean studio</h1>
        <p class="lead">Cables, nets, membranes and shells that find their form, to be watched and played with.</p>
        <ThemeChoice />
      </header>
      <main id="main" class="start" tabIndex={-1}>
        <section aria-labelledby="running-title" class="running">
          <h2 id="running-title">Sessions</h2>
          <Running />
          <FileButton />
        </section>
        <section aria-labelledby="gallery-title">
          <h2 id="gallery-title">Figures</h2>
          <p>A figure opens as a session of its own.</p>
          <Gallery />
        </section>
      </main>
    </>
  );
}
