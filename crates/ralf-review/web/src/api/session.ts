/** Who this is: the token that the page was opened with, the window, and the person, who stays the same for ever. */

const TOKEN = "ralf-token";
const AUTHOR = "ralf-author";
const NAME = "ralf-name";
const TEN_YEARS_S = 315_360_000;

export interface Session {
  /** Those that may be the server's: of these corrections, and of the newest page in this browser. */
  tokens(): readonly string[];
  /** The server has taken this one. */
  accepts(token: string): void;
  /** These corrections are served: the token that was taken stays theirs when others are served here. */
  serves(store: string): void;
  /** The window, by which the server leaves out its own changes. */
  readonly tab: string;
  /** The person in this browser: undo takes back what it did, and nobody else's. */
  readonly author: string;
  /** What the person is called; `null` until it says so. */
  name(): string | null;
  rename(name: string): void;
}

/** Takes the token out of the address, so that it isn't seen or bookmarked, and keeps it for this browser's windows. */
export function openSession(): Session {
  const address = new URL(location.href);
  const given = address.searchParams.get("token");
  if (given !== null) {
    localStorage.setItem(TOKEN, given);
    address.searchParams.delete("token");
    history.replaceState(null, "", address);
  }
  let own: string | null = null;
  let accepted: string | null = null;
  return {
    tokens: () => {
      const names = own === null ? [TOKEN, ...tokenNames()] : [own, TOKEN];
      const known = names.map((name) => localStorage.getItem(name)).filter((token) => token !== null);
      return [...new Set(known)];
    },
    accepts: (token) => {
      accepted = token;
      if (own !== null && localStorage.getItem(own) !== token) localStorage.setItem(own, token);
    },
    serves: (store) => {
      own = `${TOKEN} ${store}`;
      if (accepted !== null) localStorage.setItem(own, accepted);
    },
    tab: randomName(),
    author: knownAuthor(),
    name: () => localStorage.getItem(NAME),
    rename: (name) => localStorage.setItem(NAME, name),
  };
}

/** Under which names tokens of corrections are kept that were served here. */
function tokenNames(): readonly string[] {
  return Object.keys(localStorage).filter((name) => name.startsWith(`${TOKEN} `));
}

/**
 * A cookie, for it is known on every port of the host: the person is the same when the server listens on another
 * one.
 */
function knownAuthor(): string {
  const known = document.cookie.match(/(?:^|; )ralf-author=([0-9a-f]+)/)?.[1] ?? localStorage.getItem(AUTHOR);
  const author = known ?? randomName();
  localStorage.setItem(AUTHOR, author);
  document.cookie = `${AUTHOR}=${author}; max-age=${TEN_YEARS_S}; path=/; samesite=strict`;
  return author;
}

/** 16 random hex digits. (`crypto.randomUUID` is missing where the page isn't served from this machine.) */
export function randomName(): string {
  return Array.from(crypto.getRandomValues(new Uint8Array(8)), (byte) => byte.toString(16).padStart(2, "0")).join("");
}
