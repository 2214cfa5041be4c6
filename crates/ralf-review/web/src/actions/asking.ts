/** Edits that are asked for again while nobody answers, under one name, so that they are made once. */

import { ServerGone } from "../api/errors.js";
import { randomName } from "../api/session.js";

const PAUSES_MS = [200, 800, 2000] as const;

export async function askPatiently<Answer>(ask: (id: string) => Promise<Answer>): Promise<Answer> {
  const id = randomName();
  for (const pause of PAUSES_MS) {
    try {
      return await ask(id);
    } catch (error) {
      if (!(error instanceof ServerGone)) throw error;
    }
    await new Promise((resolve) => setTimeout(resolve, pause));
  }
  return ask(id);
}
