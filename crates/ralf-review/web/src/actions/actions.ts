/** Everything a person can do, by topic. */

import { Correcting } from "./correcting.js";
import { Hearing } from "./hearing.js";
import { Moment } from "./moment.js";
import { Navigation } from "./navigation.js";
import { Selecting } from "./selecting.js";
import { Viewing } from "./viewing.js";
import type { World } from "./world.js";

export interface Actions {
  readonly go: Navigation;
  readonly correct: Correcting;
  readonly select: Selecting;
  readonly view: Viewing;
  readonly hear: Hearing;
}

export function actionsOn(world: World): Actions {
  const go = new Navigation(world, new Moment(world));
  const correct = new Correcting(world, go);
  return {
    go,
    correct,
    select: new Selecting(world, correct),
    view: new Viewing(world),
    hear: new Hearing(world, correct),
  };
}
