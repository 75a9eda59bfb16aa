// The figures, each with its picture.
import { useEffect, useState } from "preact/hooks";
import * as api from "../api";
import type { Example } from "../model";
import { quiet, refuse } from "./notices";
import { go, met } from "./place";

export function Gallery() {
  const [examples, setExamples] = useState<Example[] | null>(null);
  const [fault, setFault] = useState("");
  const [opening, setOpening] = useState("");
  useEffect(() => {
    let here = true;
    api.examples().then(
      (found) => here && setExamples(found),
      (error: Error) => {
        met(error);
        if (here) setFault(error.message);
      },
    );
    return () => {
      here = false;
    };
  }, []);
  const choose = async (example: Example) => {
    setOpening(example.id);
    await open(example);
    setOpening("");
  };
  if (fault)
    return (
      <p class="fault" role="alert">
        The figures could not be read. {fault}
      </p>
    );
  if (!examples) return <p class="faint">Reading the figures ...</p>;
  return (
    <ul class="gallery">
      {examples.map((example) => (
        <li key={example.id}>
          <button
            type="button"
            disabled={opening !== ""}
            aria-busy={opening === example.id}
            onClick={() => void choose(example)}
          >
            <img src={example.picture} alt="" loading="lazy" width={480} height={300} />
            <span class="figure">{example.figure}</span>
            <span class="title">{example.title}</span>
            {example.summary && <span class="summary">{example.summary}</span>}
          </button>
        </li>
      ))}
    </ul>
  );
}

async function open(example: Example): Promise<void> {
  quiet();
  try {
    const made = await api.create(await api.exampleScene(example.id), example.title);
    go(made.key);
  } catch (error) {
    met(error);
    refuse(error, `${example.title} was not opened. `);
  }
}
