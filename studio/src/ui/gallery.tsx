// The figures, each with its picture.
import { useEffect, useState } from "preact/hooks";
import * as api from "../api";
import type { Example } from "../model";
import { quiet, refuse, tell } from "./notices";
import { opening } from "./opening";
import { go, met } from "./place";

const AGAIN = 4000;

export function Gallery() {
  const [examples, setExamples] = useState<Example[] | null>(null);
  const [fault, setFault] = useState("");
  useEffect(() => {
    let timer = 0;
    const read = () =>
      api.examples().then(
        (found) => {
          setFault("");
          setExamples(found);
        },
        (error: Error) => {
          met(error);
          setFault(error.message);
          timer = window.setTimeout(read, AGAIN);
        },
      );
    void read();
    return () => clearTimeout(timer);
  }, []);
  if (fault)
    return (
      <p class="fault" role="alert">
        The figures could not be read. {fault}
      </p>
    );
  if (!examples) return <p class="faint">Loading the figures ...</p>;
  return (
    <ul class="gallery">
      {examples.map((example) => (
        <li key={example.id}>
          <button
            type="button"
            disabled={opening.value !== ""}
            aria-busy={opening.value === example.title}
            onClick={() => void open(example)}
          >
            <img src={example.picture} alt="" loading="lazy" width={480} height={300} />
            <span class="figure">{example.figure}</span>
            <span class="title">{example.title}</span>
            <span class="sentence">{example.sentence}</span>
          </button>
        </li>
      ))}
    </ul>
  );
}

async function open(example: Example): Promise<void> {
  quiet();
  opening.value = example.title;
  try {
    const made = await api.create(await api.exampleScene(example.id), example.title);
    go(made.key);
    tell(example.sentence);
  } catch (error) {
    met(error);
    refuse(error, `${example.title} was not opened. `);
  } finally {
    opening.value = "";
  }
}
