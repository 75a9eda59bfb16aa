// Log-in, if this browser is not logged in.
import { useState } from "preact/hooks";
import { enter, refusedEntry } from "./place";

export function Entry() {
  const [token, setToken] = useState("");
  return (
    <main id="main" class="entry" tabIndex={-1}>
      <h1>hookean studio</h1>
      <p>
        This browser is not logged in: start <code>hookean studio</code>, or open the address that{" "}
        <code>hookean token --url</code> prints.
      </p>
      <form
        onSubmit={(event) => {
          event.preventDefault();
          void enter(token);
        }}
      >
        <label>
          <span>
            Token (<code>hookean token</code> prints it)
          </span>
          <input
            type="password"
            autocomplete="off"
            required
            value={token}
            onInput={(event) => setToken(event.currentTarget.value)}
          />
        </label>
        <button type="submit" class="first">
          Log in
        </button>
      </form>
      <p role="alert" class="fault">
        {refusedEntry.value}
      </p>
    </main>
  );
}
