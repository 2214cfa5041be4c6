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

/** Somebody else changed the same scan first; nothing was written. */
export class Conflict extends Error {
  constructor(readonly body: ConflictBody) {
    super(body.error);
  }
}

export function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
