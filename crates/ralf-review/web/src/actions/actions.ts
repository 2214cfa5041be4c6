/** Everything a person can do, by topic. */

import type { Keeper } from "../history/keep.js";
import { Adopting } from "./adopting.js";
import { Correcting } from "./correcting.js";
import { Hearing } from "./hearing.js";
import { Holding } from "./holding.js";
import { Kinding } from "./kinding.js";
import { Moment } from "./moment.js";
import { Opining } from "./opining.js";
import { Navigation } from "./navigation.js";
import { Picking } from "./picking.js";
import { Queueing } from "./queueing.js";
import { Relabelling } from "./relabelling.js";
import { Reviewing } from "./reviewing.js";
import { Recalling } from "./recalling.js";
import { Replaying } from "./replaying.js";
import { Ruling } from "./ruling.js";
import { Selecting } from "./selecting.js";
import { Settling } from "./settling.js";
import { Stepping } from "./stepping.js";
import { Thinging } from "./thinging.js";
import { Viewing } from "./viewing.js";
import type { World } from "./world.js";

export interface Actions {
  readonly go: Navigation;
  readonly correct: Correcting;
  readonly review: Reviewing;
  readonly step: Stepping;
  readonly select: Selecting;
  readonly pick: Picking;
  readonly view: Viewing;
  readonly hear: Hearing;
  readonly hold: Holding;
  readonly thing: Thinging;
  readonly rule: Ruling;
  readonly replay: Replaying;
  readonly opine: Opining;
  readonly kind: Kinding;
  readonly settle: Settling;
  readonly recall: Recalling;
}

export function actionsOn(world: World, keeper: Keeper): Actions {
  const moment = new Moment(world);
  const go = new Navigation(world, moment);
  const queueing = new Queueing(world);
  const adopting = new Adopting(world, queueing, moment);
  const relabelling = new Relabelling(world);
  const thing = new Thinging(world, go, adopting);
  const correct = new Correcting(world, go, adopting, keeper);
  const settle = new Settling(world, go, correct);
  const kind = new Kinding(world, go, correct);
  const select = new Selecting(world, correct, thing, settle, kind);
  return {
    go,
    correct,
    review: new Reviewing(world, go, adopting, correct, queueing),
    step: new Stepping(world, go, adopting, correct),
    select,
    pick: new Picking(world),
    view: new Viewing(world),
    hear: new Hearing(world, adopting, correct, queueing, relabelling),
    hold: new Holding(world),
    thing,
    rule: new Ruling(world, go, select, correct),
    replay: new Replaying(world, correct),
    opine: new Opining(world, go, correct),
    kind,
    settle,
    recall: new Recalling(world),
  };
}
