// Record, scrub, replay, bookmarks, and the recording as a video.
import { useSignal } from "@preact/signals";
import { refuse } from "./notices";
import { type Film, momentOf, SPEEDS } from "./film";
import { keep } from "./out";
import type { Studio } from "./studio";
import { counted, said } from "./words";

export function Timeline({ studio, title }: { studio: Studio; title: string }) {
  const { film, session } = studio;
  void film.version.value;
  const live = session.connection.value === "live";
  const isRecording = film.recording.value;
  const count = film.shots.length;
  const thinned = film.stride > 1 ? `, one in ${film.stride} kept` : "";
  return (
    <div class="timeline">
      <div class="row">
        <button
          type="button"
          aria-pressed={isRecording}
          disabled={!live && !isRecording}
          title="Keep each frame that arrives, here and in saved .hookean files. Long recordings are thinned to 96 MB"
          onClick={() => (isRecording ? film.stop() : film.record())}
        >
          {isRecording ? "Stop recording" : "Record"}
        </button>
        <button type="button" disabled={!count} title="Delete the recording" onClick={() => film.clear()}>
          Delete recording
        </button>
      </div>
      {count > 0 && <Scrub studio={studio} />}
      <p class="faint" role="status">
        {count
          ? `${counted(count, "frame")} in ${said(film.length, 3)} s${thinned}`
          : "Nothing recorded yet: press Record, then Play or drag."}
      </p>
      {!film.kept.value && (
        <p class="fault">This browser does not keep recordings: save a video before you close the page.</p>
      )}
      <Bookmarks studio={studio} />
      {count > 1 && <Video studio={studio} title={title} />}
    </div>
  );
}

function Scrub({ studio }: { studio: Studio }) {
  const { film, session } = studio;
  const last = film.shots.length - 1;
  const at = film.shown.value ?? last;
  const shot = film.shots[at]!;
  const unit = session.topology.value?.units.time ?? "";
  return (
    <>
      <label class="scrub" title="Drag, or use the arrow keys, to go through the recording">
        <span>Moment</span>
        <output class="numbers">
          {said(shot.at, 3)} s · {momentOf(shot.frame, unit)}
        </output>
        <input
          type="range"
          aria-label="Moment of the recording"
          aria-valuetext={`${said(shot.at, 3)} s of ${said(film.length, 3)} s`}
          min={0}
          max={last}
          step={1}
          value={at}
          disabled={film.recording.value}
          onInput={(event) => {
            film.pause();
            film.show(event.currentTarget.valueAsNumber);
          }}
        />
      </label>
      <div class="row">
        <button
          type="button"
          aria-pressed={film.replaying.value}
          title="Play the recording from this moment on; the model does not change"
          onClick={() => (film.replaying.value ? film.pause() : film.replay())}
        >
          {film.replaying.value ? "Pause replay" : "Replay"}
        </button>
        <Speed film={film} />
      </div>
    </>
  );
}

const Speed = ({ film }: { film: Film }) => (
  <label class="check" title="Speed of the replay; 1 is as it was recorded">
    Speed
    <select
      value={String(film.speed.value)}
      aria-label="Speed of the replay"
      onChange={(event) => film.pace(Number(event.currentTarget.value))}
    >
      {SPEEDS.map((speed) => (
        <option key={speed} value={String(speed)}>
          {speed} ×
        </option>
      ))}
    </select>
  </label>
);

function Bookmarks({ studio: { film, view } }: { studio: Studio }) {
  const name = useSignal("");
  const marks = film.bookmarks.value;
  const free = `moment ${marks.length + 1}`;
  return (
    <>
      <form
        class="row"
        onSubmit={(event) => {
          event.preventDefault();
          film.mark(name.value.trim() || free, view.value?.place() ?? null);
          name.value = "";
        }}
      >
        <input
          type="text"
          aria-label="Name of the bookmark"
          title="A name for the shape and view that are shown"
          maxLength={60}
          placeholder={free}
          value={name.value}
          onInput={(event) => (name.value = event.currentTarget.value)}
        />
        <button type="submit" title="Keep the shape that is shown and the view, here and in saved .hookean files">
          Bookmark
        </button>
      </form>
      {marks.length > 0 && (
        <ul class="bookmarks" aria-label="Bookmarks">
          {marks.map((mark, i) => (
            <li key={i}>
              <button
                type="button"
                title="Show this shape, from where it was seen"
                onClick={() => {
                  film.recall(mark);
                  if (mark.place) view.value?.put(mark.place);
                }}
              >
                {mark.name}
              </button>
              <button
                type="button"
                class="plain"
                aria-label={`Delete bookmark ${mark.name}`}
                title="Delete"
                onClick={() => film.forget(mark)}
              >
                ×
              </button>
            </li>
          ))}
        </ul>
      )}
    </>
  );
}

const RATES = [15, 30, 60];

function Video({ studio, title }: { studio: Studio; title: string }) {
  const rate = useSignal(30);
  const part = useSignal<number | null>(null);
  const done = useSignal("");
  const stop = useSignal<AbortController | null>(null);
  const save = async () => {
    const { filmed } = await import("./video");
    const giveUp = (stop.value = new AbortController());
    part.value = 0;
    done.value = "";
    try {
      const { blob, ending, note } = await filmed(studio, title, rate.value, {
        progress: (now) => (part.value = now),
        signal: giveUp.signal,
      });
      const file = `${title.replace(/[^\w.-]+/g, "-").replace(/^-+|-+$/g, "") || "session"}${ending}`;
      keep(blob, file);
      done.value = `${file} was downloaded.${note}`;
    } catch (error) {
      if (!giveUp.signal.aborted) refuse(error, "The video was not saved. ");
    } finally {
      part.value = stop.value = null;
    }
  };
  return (
    <>
      <div class="row">
        <button
          type="button"
          disabled={part.value !== null || studio.film.recording.value || !studio.view.value}
          title="The recording, as it is looked at now, as a WebM video, or a zip of pictures where there is no encoder"
          onClick={() => void save()}
        >
          Save video
        </button>
        <label class="check" title="Pictures per second of the video; usual are 25 to 60">
          Pictures per second
          <select
            value={String(rate.value)}
            aria-label="Pictures per second"
            onChange={(event) => (rate.value = Number(event.currentTarget.value))}
          >
            {RATES.map((one) => (
              <option key={one} value={String(one)}>
                {one}
              </option>
            ))}
          </select>
        </label>
      </div>
      {part.value !== null && (
        <div class="row">
          <progress aria-label="Video" value={part.value} max={1} />
          <button type="button" class="small" onClick={() => stop.value?.abort()}>
            Cancel video
          </button>
        </div>
      )}
      <p role="status" class="done">
        {done.value}
      </p>
    </>
  );
}
