// The start page: figures, sessions and files to open.
import { useEffect } from "preact/hooks";
import { Gallery } from "./gallery";
import { New } from "./new";
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
        <p class="lead">Form finding of cables, nets, membranes and shells that you can watch and edit.</p>
        <ThemeChoice />
      </header>
      <main id="main" class="start" tabIndex={-1}>
        <section aria-labelledby="running-title" class="running">
          <h2 id="running-title">Sessions</h2>
          <Running />
          <New />
          <FileButton />
        </section>
        <section aria-labelledby="gallery-title">
          <h2 id="gallery-title">Figures</h2>
          <p>Each figure opens as a new session.</p>
          <Gallery />
        </section>
      </main>
    </>
  );
}
