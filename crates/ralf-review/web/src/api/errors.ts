import type { ConflictBody } from "./types.js";

/** Nobody answered: the server has ended or can't be reached. */
export class ServerGone extends Error {
  constructor() {
    super("the server does not answer");
  }
}

/** The server refused, and says why. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    message: string,
  ) {
    super(message);
  }
}

/** The page was opened without the token, or the server was started again with another one. */
export class TokenMissing extends Refused {
  constructor() {
    super(401, "this window has no token of the server: open the address that `ralf review` printed");
  }
}

/** Other corrections are served here than those that the page was opened on: nothing was written. */
export class Elsewhere extends Refused {
  constructor(message: string) {
    super(412, message);
  }
}

/** Whether no server is there, or another one, which may know another token. */
export function isAway(error: unknown): boolean {
  return error instanceof ServerGone || error instanceof Elsewhere || error instanceof TokenMissing;
}

/** Somebody else changed the same scan first; nothing was written. */
export class Conflict extends Error {
  constructor(readonly body: ConflictBody) {
    super(body.error);
  }
}

/** Whether the server answers, and does so for the corrections of this page. */
export type Link =
  | { readonly kind: "fine" }
  | { readonly kind: "gone" }
  | { readonly kind: "elsewhere"; readonly message: string }
  /** It can't read the corrections, so that nothing is saved any more. */
  | { readonly kind: "broken"; readonly message: string };

export function linkAfter(error: unknown): Link {
  if (error instanceof ServerGone) return { kind: "gone" };
  return { kind: error instanceof Elsewhere ? "elsewhere" : "broken", message: messageOf(error) };
}

export function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
