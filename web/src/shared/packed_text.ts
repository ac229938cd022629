/** Text in addresses: deflated, in base64url. */

/** Longer packed scenarios are stored in the browser tab instead of the address. */
const maxLength = 5000;

export async function pack(text: string): Promise<string> {
  const packed = `z${base64(await through(new CompressionStream("deflate-raw"), new TextEncoder().encode(text)))}`;
  return packed.length <= maxLength ? packed : storeInTab(text);
}

/** Whether only this browser tab can unpack the text. */
export function isStoredInTab(packed: string | null): boolean {
  return packed?.startsWith("k") ?? false;
}

/** The text; null if it is unavailable. */
export async function unpack(packed: string): Promise<string | null> {
  if (isStoredInTab(packed)) return sessionStorage.getItem(packed);
  try {
    const bytes = Uint8Array.from(atob(unescaped(packed.slice(1))), (character) => character.charCodeAt(0));
    return new TextDecoder().decode(await through(new DecompressionStream("deflate-raw"), bytes));
  } catch {
    return null;
  }
}

function storeInTab(text: string): string {
  const key = `k${Date.now().toString(36)}`;
  sessionStorage.setItem(key, text);
  return key;
}

async function through(stream: CompressionStream | DecompressionStream, bytes: Uint8Array<ArrayBuffer>) {
  const piped = new Blob([bytes]).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(piped).arrayBuffer());
}

function base64(bytes: Uint8Array): string {
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""))
    .replaceAll("+", "-")
    .replaceAll("/", "_")
    .replaceAll("=", "");
}

function unescaped(text: string): string {
  return text.replaceAll("-", "+").replaceAll("_", "/");
}
