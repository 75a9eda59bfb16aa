// Texts in addresses: compressed (raw deflate, base64url), as groups of many particles are long.

const stream = (bytes: BlobPart, through: TransformStream) =>
  new Response(new Blob([bytes]).stream().pipeThrough(through)).arrayBuffer();

/** A text as an address carries it, of letters, digits, - and _ only. */
export async function packed(text: string): Promise<string> {
  const bytes = new Uint8Array(await stream(text, new CompressionStream("deflate-raw")));
  const letters = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
  return btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** The text that `packed` was given; rejects where it was cut. */
export async function unpacked(told: string): Promise<string> {
  const letters = atob(told.replaceAll("-", "+").replaceAll("_", "/"));
  const bytes = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
  return new TextDecoder().decode(await stream(bytes, new DecompressionStream("deflate-raw")));
}

/** Whether a text is packed: JSON of an object is not. */
export const isPacked = (told: string) => /^[\w-]+$/.test(told);
