// A sequence of a hundred scans, corrected by somebody who knows the truth and has nothing but the page: how many
// gestures that takes. A gesture is a key, or a press or drag of the mouse.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { bestLasso, inside } from "./annotator.mjs";
import {
  anotherBrowser,
  ask,
  clean,
  current,
  freshFolder,
  launch,
  open,
  picture,
  pixel,
  queueOf,
  ralf,
  ready,
  says,
  scanOf,
  sequenceOf,
  serve,
  status,
} from "./support.mjs";

const { RALF_ANNOTATE, RALF_ANNOTATE_SCANS = "275", RALF_ANNOTATE_UNTIL = "0.45" } = process.env;
/** At most so many gestures for each corrected detection; without things, maps and kinds it was 1.5. */
const EACH = 0.03;
/** A tenth of the scans' worth of gestures, and at least this share of the wrong labels is gone after them. */
const [FEW, GONE] = [10, 0.5];
/** Half of the wrong labels are gone after this many at most. */
const HALF = 15;
/** The share of wrong labels at which it is enough. */
const ENOUGH = Number(RALF_ANNOTATE_UNTIL);
/** A lasso that corrects fewer isn't worth the way. */
const WORTH = 7;
const PLACES = 150;
/** The line between what is asked about and what isn't is drawn elsewhere where this share of a kind more is right then. */
const CLEARLY = 0.05;
/** Who has left so many kinds as they are in turn looks for something else to do. */
const VAIN = Number(process.env.RALF_ANNOTATE_KINDS ?? 4);
/** After so many gestures, and then after each half as many again, the page is asked to relabel by what was said. */
const ASKED = Number(process.env.RALF_ANNOTATE_ASK ?? 7);
const [ARTIFACT, PLAUSIBLE] = [1, 99];

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

test("a sequence is corrected in a tenth of the gestures", { timeout: 900_000 }, async (context) => {
  const { dataset, out } = await labelled(context);
  const server = await serve(context, out, { dataset });
  const own = await anotherBrowser(context, browser, { width: 1280, height: 720 });
  const tab = await open(context, browser, server, own);
  const { page } = tab;
  const devtools = await own.newCDPSession(page);
  let all = await everyDetection(server, dataset);
  const errors = wrong(all);
  const told = [{ gestures: 0, left: errors }];
  let gestures = 0;
  const press = async (key) => {
    gestures += 1;
    await page.keyboard.press(key);
  };
  // What one answer can be about all over the sequence comes first.
  gestures += await answeredKinds(server, page, all, (at) => told.push({ gestures: at, left: wrong(all) }));
  // Without LiDAR the picture is drawn in a third of the time.
  await press("k");
  await press("o");
  await press("l");
  let armed = null;
  let again = ASKED;
  for (let place = 0; place < PLACES && wrong(all) > ENOUGH * errors; place += 1) {
    if (armed === null) {
      await press("a");
      armed = ARTIFACT;
    }
    if (!(await nextPlace(page, press))) break;
    const view = await viewOf(server, page, all);
    while (wrong(all) > ENOUGH * errors) {
      const lassos = [PLAUSIBLE, ARTIFACT].map((from) => ({
        from,
        lasso: bestLasso(view.seen, from === PLAUSIBLE, WORTH),
      }));
      // Another label is another gesture.
      const each = ({ from: label, lasso: drawn }) => (drawn?.gain ?? 0) / (label === armed ? 2 : 1);
      const [{ from, lasso }] = lassos.sort((a, b) => each(b) - each(a));
      if (lasso === null) break;
      const wanted = from === PLAUSIBLE ? ARTIFACT : PLAUSIBLE;
      if (wanted !== armed) await press(wanted === ARTIFACT ? "a" : "p");
      armed = wanted;
      gestures += 1;
      await around(page, devtools, await Promise.all(lasso.corners.map(([x, y]) => pixel(page, x, y))));
      for (const one of view.seen) {
        if (one.label === (from === PLAUSIBLE) && inside([one.x, one.y], lasso.corners))
          one.of.label = one.label = wanted === PLAUSIBLE;
      }
      told.push({ gestures, left: wrong(all) });
    }
    if (gestures < again || wrong(all) <= ENOUGH * errors) continue;
    const accepted = await relabelled(server, page, press, all);
    again = Math.ceil(1.5 * gestures);
    if (accepted) all = await everyDetection(server, dataset);
    told.push({ gestures, left: wrong(all) });
  }
  await says(status(page), "saved");
  report(told, errors, all.scans);
  const now = await everyDetection(server, dataset);
  const last = told[told.length - 1];
  const drawn = Math.abs(wrong(now) - last.left);
  assert.ok(drawn <= 0.02 * errors, `the page has ${wrong(now)} wrong labels, the annotator expects ${last.left}`);
  // Another sequence is looked at for its own sake.
  if (RALF_ANNOTATE === undefined) {
    const corrected = errors - wrong(now);
    assert.ok(gestures <= EACH * corrected, `${gestures} gestures, ${corrected} corrected`);
    const { left } = told.findLast((one) => one.gestures <= FEW);
    assert.ok(left <= (1 - GONE) * errors, `${left} of ${errors} are wrong after ${FEW} gestures`);
    const half = told.find((one) => one.left <= errors / 2);
    assert.ok(half !== undefined && half.gestures <= HALF, `half after ${half?.gestures} gestures`);
  }
  clean(tab);
});

/** A simulated sequence of about a hundred scans, with labels; RALF_ANNOTATE names another one: DATASET:OUT. */
async function labelled(context) {
  if (RALF_ANNOTATE !== undefined) {
    const [dataset, out] = RALF_ANNOTATE.split(":");
    return { dataset, out };
  }
  const folder = await freshFolder(context);
  const [dataset, out] = ["recording", "out"].map((name) => join(folder, name));
  const scans = ["--scans", RALF_ANNOTATE_SCANS, "--sequence", "00", "--no-images"];
  ralf("simulate", "-o", dataset, ...scans, "--quiet");
  ralf("label", dataset, "-o", out, "--quiet");
  return { dataset, out };
}

/** Every detection with its place in the odometry frame, its label and the truth; true is plausible. */
async function everyDetection(server, dataset) {
  const { scans } = await queueOf(server);
  const recording = await (await ask(server, "recording")).json();
  const truthOf = new Map(recording.classes.map(({ id, plausible }) => [id, plausible]));
  const all = [];
  const starts = new Map();
  for (const { radar, scan } of scans) {
    starts.set(`${radar}/${scan}`, all.length);
    const table = await scanOf(server, { radar, scan });
    const name = `${String(scan).padStart(6, "0")}.label`;
    const file = await readFile(join(dataset, "sequences", recording.sequences[0].name, "ground_truth", radar, name));
    const m = table.header.odom_from_vehicle;
    table.x.forEach((x, i) => {
      const [y, z] = [table.y[i], table.z[i]];
      const at = (row) => m[row] * x + m[row + 1] * y + m[row + 2] * z + m[row + 3];
      const truth = truthOf.get(file.readUInt32LE(4 * i) & 0xffff);
      all.push({ place: [at(0), at(4), at(8)], label: truthOf.get(table.label[i]), truth });
    });
  }
  return Object.assign(all, { scans: scans.length, starts });
}

function wrong(all) {
  return all.filter(({ label, truth }) => label !== truth).length;
}

/** To where the queue sends next; false where it has nothing left. */
async function nextPlace(page, press) {
  const viewport = page.locator(".viewport");
  const aim = () => viewport.getAttribute("data-target");
  const from = await aim();
  await press("Shift+N");
  for (let wait = 0; wait < 300; wait += 1) {
    await page.waitForTimeout(50);
    const done = await page.locator(".notice").textContent();
    if (done?.includes("Every doubtful thing")) return false;
    if ((await aim()) !== from) break;
  }
  await ready(page);
  return true;
}

/**
 * Goes through the kinds that the page asks about, until so many in turn were left as they are or none is left: each is
 * answered where that makes more labels right than wrong; where that is clearly better the line is drawn elsewhere first,
 * by one drag of the slider. Gives the number of gestures.
 */
async function answeredKinds(server, page, all, after) {
  const labels = new Map(
    (await (await ask(server, "recording")).json()).classes.map(({ id, plausible }) => [id, plausible]),
  );
  let gestures = 0;
  let inVain = 0;
  let key = "Shift+G";
  while (inVain < VAIN) {
    const asked = page.waitForResponse(/\/kinds\?/, { timeout: 300_000 });
    await page.keyboard.press(key);
    gestures += 1;
    const { next } = await (await asked).json();
    if (next === null) break;
    await page.locator(`.kind-bar[data-kind="${next.kind}"]:not([hidden])`).waitFor();
    await picture(page, `kind-${gestures}`);
    const rows = next.points.flatMap(({ radar, scan, points }) =>
      points.map((point) => all[all.starts.get(`${radar}/${scan}`) + point]),
    );
    const called = labels.get(next.label);
    const gains = gainsAt(rows, next.ranks, called);
    const line = page.locator(".kind-bar .line");
    let at = Number(await line.inputValue());
    assert.equal(Number(await line.getAttribute("max")), gains.length - 1);
    const best = gains.indexOf(Math.max(...gains));
    const [gain, more] = [gains[best], gains[best] - Math.max(0, gains[at])];
    const drawn = gain >= WORTH && more >= Math.max(WORTH, CLEARLY * rows.length);
    if (drawn) {
      gestures += 1;
      await slide(page, line, best);
      at = best;
    }
    const chosen = rows.filter((_, i) => next.ranks[i] < linesOf(rows.length)[at]);
    console.log(
      `${next.kind}: ${chosen.length} of ${rows.length} detections${drawn ? ", by a drag" : ""}, ${gains[at]} more are right if it's said`,
    );
    if (gains[at] < WORTH) {
      key = "Shift+G";
      inVain += 1;
      continue;
    }
    inVain = 0;
    key = called ? "a" : "p";
    for (const row of chosen) row.label = !called;
    after(gestures + 1);
  }
  // What is looked at last is neither answered nor in the way.
  await page.keyboard.press("Escape");
  return gestures + 1;
}

/** How many more labels are right once all up to each line have the other label. */
function gainsAt(rows, ranks, called) {
  const byRank = [];
  rows.forEach(({ truth }, i) => (byRank[ranks[i]] = truth === called ? -1 : 1));
  let gain = 0;
  const sums = byRank.map((one) => (gain += one));
  return linesOf(rows.length).map((count) => sums[count - 1]);
}

/** How many detections lie before each line that the slider can stand at. */
function linesOf(detections) {
  return [...new Set(Array.from({ length: 20 }, (_, i) => Math.max(1, Math.round((detections * (i + 1)) / 20))))];
}

/** Drags a slider until it stands at a line, with an eye on where it stands. */
async function slide(page, slider, wanted) {
  const box = await slider.boundingBox();
  const last = Number(await slider.getAttribute("max"));
  const stands = async () => Number(await slider.inputValue());
  // The thumb's middle stays half of its width from either end.
  const half = box.height / 2;
  const [y, step] = [box.y + half, (box.width - 2 * half) / last];
  const place = (at) => box.x + half + step * at;
  await page.mouse.move(place(await stands()), y);
  await page.mouse.down();
  let x = place(wanted);
  for (let moves = 0; moves < 40; moves += 1) {
    await page.mouse.move(x, y);
    const off = wanted - (await stands());
    if (off === 0) break;
    x += (off * step) / 4;
  }
  await page.mouse.up();
  assert.equal(await stands(), wanted);
}

/** Asks what would change by what was said, looks at it, and accepts it where it's more right than wrong. */
async function relabelled(server, page, press, all) {
  await says(status(page), "saved");
  await press("Shift+R");
  const bar = page.locator(".opinion-bar");
  await page.waitForFunction(
    () => {
      const bar = document.querySelector(".opinion-bar");
      return bar.hidden || bar.textContent.includes("would become");
    },
    null,
    { timeout: 300_000 },
  );
  if (!(await bar.isVisible())) return false;
  await picture(page, "proposal-of-a-sequence");
  const { changes } = await (await ask(server, `sequences/${await sequenceOf(server)}/opinion`)).json();
  let gain = 0;
  for (const { label, points } of changes) {
    for (const { radar, scan, points: rows } of points) {
      const begin = all.starts.get(`${radar}/${scan}`);
      for (const row of rows) gain += all[begin + row].truth === (label === PLAUSIBLE) ? 1 : -1;
    }
  }
  await press(gain > 0 ? "Shift+R" : "Escape");
  await bar.waitFor({ state: "hidden" });
  await says(status(page), /^saved$/);
  console.log(
    `a proposal of ${changes.length} things: ${gain > 0 ? "accepted" : "dropped"}, ${gain} labels more are right`,
  );
  return gain > 0;
}

/** A lasso around places of the window, drawn without waiting for the page's pictures of it. */
async function around(page, devtools, places) {
  const at = (type, [x, y], buttons) =>
    devtools.send("Input.dispatchMouseEvent", { type, x, y, buttons, button: "left", clickCount: 1 });
  await page.mouse.move(...places[0]);
  const drawn = [at("mousePressed", places[0], 1), ...places.map((place) => at("mouseMoved", place, 1))];
  await Promise.all([...drawn, at("mouseReleased", places[places.length - 1], 0)]);
}

/** What the bird's eye shows well inside its frame, in the vehicle frame of the scan on screen. */
async function viewOf(server, page, all) {
  const { header } = await scanOf(server, await current(page));
  const m = header.odom_from_vehicle;
  const viewport = page.locator(".viewport");
  const box = await viewport.boundingBox();
  const metres = Number(await viewport.getAttribute("data-metres-per-pixel"));
  const [cx, cy] = (await viewport.getAttribute("data-target")).split(" ").map(Number);
  const [along, across] = [0.42 * box.height * metres, 0.42 * box.width * metres];
  const seen = [];
  for (const one of all) {
    const [dx, dy, dz] = [one.place[0] - m[3], one.place[1] - m[7], one.place[2] - m[11]];
    const [x, y] = [m[0] * dx + m[4] * dy + m[8] * dz, m[1] * dx + m[5] * dy + m[9] * dz];
    if (Math.abs(x - cx) < along && Math.abs(y - cy) < across)
      seen.push({ x, y, label: one.label, truth: one.truth, of: one });
  }
  return { seen };
}

/** The curve: how much is wrong after how many gestures. */
function report(told, errors, scans) {
  const { gestures, left } = told[told.length - 1];
  const rows = [`${scans} scans, ${errors} wrong labels`, "gestures  wrong labels left"];
  for (const at of [0, 10, 20, 40, 80, 160, 320, 640]) {
    const then = told.filter((one) => one.gestures <= at).at(-1);
    if (at <= gestures) rows.push(`${String(at).padStart(8)}  ${((100 * then.left) / errors).toFixed(1)} %`);
  }
  const half = told.find((one) => one.left <= errors / 2)?.gestures ?? "never";
  rows.push(
    `${gestures} gestures corrected ${errors - left}: ${(gestures / (errors - left)).toFixed(3)} each; half after ${half}`,
  );
  console.log(rows.join("\n"));
}
