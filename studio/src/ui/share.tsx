// A link that shows the session as it is looked at now, read-only, to another person on this machine.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import * as api from "../api";
import type { Kept } from "../view/types";
import { Copied } from "./copied";
import { fitting } from "./kept";
import { refuse } from "./notices";
import { linkTo, met } from "./place";
import type { Studio } from "./studio";

/** How the session is looked at now, with what is picked; null where nothing is drawn. */
export function seenNow({ view, options, surfacing }: Studio): Kept | null {
  if (!view.value) return null;
  const [picked, marked, surface] = [options.picked.value, options.marked.value, surfacing.chosen.value];
  const isRead = surface.scalar !== null || surface.heights || surface.water;
  return {
    ...view.value.kept(),
    ...(picked && { picked }),
    ...(marked.length && { marked }),
    ...(isRead && { surface }),
  };
}

export function Share({ studio }: { studio: Studio }) {
  const { session } = studio;
  const isLinked = useSignal(false);
  const address = useSignal("");
  const done = useSignal("");
  const live = session.connection.value === "live";
  useEffect(() => {
    if (live) void api.linked(session.key).then((is) => (isLinked.value = is), met);
  }, [live]);
  const copy = async () => {
    try {
      const token = await api.link(session.key);
      isLinked.value = true;
      const seen = seenNow(studio);
      const kept = seen && (await fitting(seen));
      const made = `${location.origin}/#g=${token}&${linkTo(session.key).slice(1)}${kept ? `&v=${kept.view}` : ""}`;
      address.value = "";
      await navigator.clipboard.writeText(made).catch(() => (address.value = made));
      const how = address.value ? "Copy the link below." : "The read-only link was copied.";
      const where = "It shows this view in any browser of this machine, until you revoke it or delete the session.";
      done.value = [how, where, ...(kept?.notes ?? [])].join(" ");
    } catch (error) {
      met(error);
      refuse(error, "There is no read-only link. ");
    }
  };
  const revoke = async () => {
    try {
      await api.unlink(session.key);
      isLinked.value = false;
      address.value = "";
      done.value = "The read-only link is no longer valid; pages that it opened are disconnected.";
    } catch (error) {
      met(error);
      refuse(error, "The read-only link was not revoked. ");
    }
  };
  return (
    <div role="group" aria-label="Read-only link">
      <div class="row">
        <button
          type="button"
          disabled={!live}
          title="For another person on this machine: the same session and view, live, to read and measure only"
          onClick={() => void copy()}
        >
          Copy a read-only link
        </button>
        {isLinked.value && (
          <button type="button" disabled={!live} title="End the link for all who have it" onClick={() => void revoke()}>
            Revoke the read-only link
          </button>
        )}
      </div>
      <Copied told={done.value} address={address.value} name="Read-only link" />
    </div>
  );
}
