/** Who this tab is: the token it was opened with, and a name by which the server leaves out its own changes. */

const TOKEN = "ralf-token";

export interface Session {
  readonly token: string | null;
  readonly tab: string;
}

/** Takes the token out of the address, so that it isn't seen or bookmarked, and keeps it as long as the tab lives. */
export function openSession(): Session {
  const address = new URL(location.href);
  const given = address.searchParams.get("token");
  if (given !== null) {
    sessionStorage.setItem(TOKEN, given);
    address.searchParams.delete("token");
    history.replaceState(null, "", address);
  }
  return { token: sessionStorage.getItem(TOKEN), tab: randomName() };
}

/** 16 random hex digits. (`crypto.randomUUID` is missing where the page isn't served from this machine.) */
export function randomName(): string {
  return Array.from(crypto.getRandomValues(new Uint8Array(8)), (byte) => byte.toString(16).padStart(2, "0")).join("");
}
