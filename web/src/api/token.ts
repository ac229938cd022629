/**
 * The token of a server that needs one. The address that the server printed contains it. The cookie for all other
 * requests is not enough to find the drive: a browser sends it to every port of the host. The storage is this port's.
 */
const name = "agent-economy-token";
let token: string | null = null;

/** Takes the token from an address of the page, and keeps it for later ones; returns the address without it. */
export function keepToken(address: string, storage: () => Storage = () => localStorage): string {
  const url = new URL(address);
  token = url.searchParams.get("token");
  url.searchParams.delete("token");
  try {
    if (token === null) token = storage().getItem(name);
    else storage().setItem(name, token);
  } catch {
    // Without storage, the token is lost when the page is loaded again.
  }
  return url.href;
}

/** The fields of a request that needs the token. */
export function tokenFields(): Record<string, string> {
  return token === null ? {} : { [name]: token };
}
