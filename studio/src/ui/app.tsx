// The whole page: a start page, and one for each session, with notices beside it; files can be dropped on both.
import { guest } from "../guest";
import { Entry } from "./entry";
import { Notices } from "./notices";
import { Dropping, Opening } from "./opening";
import { entries, entry, place } from "./place";
import { Sheet } from "./sheet";
import { Start } from "./start";
import { SessionPage } from "./studio";

export function App() {
  return (
    <>
      <a class="skip" href="#main" onClick={skip}>
        Skip to the content
      </a>
      <div class="shown">
        <Shown />
      </div>
      <div class="notices">
        {!guest && <Opening />}
        <Notices />
      </div>
      {!guest && <Dropping />}
      {!guest && <Sheet />}
    </>
  );
}

function Shown() {
  const key = place.value;
  if (entry.value === "out") return guest ? <Ended /> : <Entry />;
  if (entry.value === "asking" || key === null)
    return (
      <main id="main" class="entry" tabIndex={-1}>
        <p>Connecting to the service ...</p>
      </main>
    );
  return key ? <SessionPage key={`${key} ${entries.value}`} name={key} /> : <Start />;
}

const Ended = () => (
  <main id="main" class="entry" tabIndex={-1}>
    <h1>hookean studio</h1>
    <p>
      This read-only link is no longer valid: it was revoked, or its session was deleted, or the service has ended. Ask
      the person who shared it for another one.
    </p>
  </main>
);

// the part after # names the session that is shown, so the link moves the focus itself
function skip(event: Event): void {
  event.preventDefault();
  document.getElementById("main")?.focus();
}
