// From start to end in a real browser: what a person does, and what must never happen to their work.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import {
  GONE,
  REFUSED,
  accept,
  anotherBrowser,
  clean,
  current,
  drag,
  exported,
  freshOut,
  historyOf,
  lassoAll,
  launch,
  open,
  opened,
  pixel,
  planted,
  proposing,
  queueOf,
  ready,
  says,
  scanOf,
  selected,
  serve,
  status,
} from "./support.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

test("the page loads from its server alone, and shows the neediest scan with cameras and queue", async (context) => {
  const { server, tab, page } = await opened(context, browser);
  const [first] = (await queueOf(server)).scans;
  assert.deepEqual(await current(page), { radar: first.radar, scan: first.scan });
  assert.equal(await page.locator(".queue-row[aria-selected=true]").count(), 1);
  await page.waitForFunction(() => document.querySelectorAll(".camera-thumb:not([hidden])").length === 3);
  await says(page.locator(".details"), "This scan");
  clean(tab);
});

test("hovering a detection shows its numbers", async (context) => {
  const { server, tab } = await opened(context, browser);
  const scan = await scanOf(server, await current(tab.page));
  const point = scan.range.findIndex((range) => range > 5 && range < 40);
  await tab.page.mouse.move(...(await pixel(tab.page, scan.x[point], scan.y[point])));
  await tab.page.locator(".details .branches").waitFor();
  await says(tab.page.locator(".details"), "doppler");
  clean(tab);
});

test("a press on a scan counts though the list is drawn anew before it ends", async (context) => {
  const { tab, page } = await opened(context, browser);
  const row = page.locator(".queue-row").nth(2);
  const [radar, scan] = await row.locator(".queue-name > *").allTextContents();
  const box = await row.boundingBox();
  await page.mouse.move(box.x + 40, box.y + box.height / 2);
  await page.mouse.down();
  await page.locator(".queue-list").evaluate((list) => list.dispatchEvent(new Event("scroll")));
  await page.mouse.up();
  await page.waitForFunction(([radar, scan]) => location.hash.endsWith(`${radar}/${scan}`), [radar, scan]);
  const there = await current(page);
  await page.mouse.move(box.x + 40, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + 40, box.y - box.height / 2);
  await page.mouse.up();
  assert.deepEqual(await current(page), there, "a press that ended on another row");
  // A screen reader's press has no place.
  await page
    .locator(".queue-row")
    .nth(1)
    .evaluate((other) => other.click());
  const chosen = await page.locator(".queue-row").nth(1).locator(".queue-name > *").allTextContents();
  await page.waitForFunction((name) => location.hash.endsWith(name.join("/")), chosen);
  clean(tab);
});

test("a lasso corrects, undo takes it back, redo sets it again, and a reload knows it all", async (context) => {
  const { server, tab, page } = await opened(context, browser);
  const id = await current(page);
  await lassoAll(page);
  const count = await selected(page);
  assert.ok(count > 20, `${count} selected`);
  await page.keyboard.press("a");
  await says(page.locator(".status-bar"), "undo 1");
  await says(status(page), "saved");
  const corrected = async () => (await scanOf(server, id)).corrected.reduce((sum, one) => sum + one, 0);
  assert.equal(await corrected(), count);
  await page.keyboard.press("Control+z");
  await says(page.locator(".status-bar"), "redo 1");
  assert.equal(await corrected(), 0);
  await page.reload();
  await ready(page);
  await says(page.locator(".status-bar"), "redo 1");
  await page.keyboard.press("Control+Shift+z");
  await says(page.locator(".status-bar"), "undo 1");
  assert.equal(await corrected(), count);
  clean(tab);
});

test("what is corrected is protected until that is turned off; flipping is one step", async (context) => {
  const { server, tab, page } = await opened(context, browser);
  const id = await current(page);
  await lassoAll(page);
  await page.keyboard.press("p");
  await says(page.locator(".status-bar"), "undo 1");
  await lassoAll(page);
  await page.keyboard.press("a");
  await says(page.locator(".notice"), "protected");
  const labels = async (wanted) => (await scanOf(server, id)).label.filter((label) => label === wanted).length;
  const plausible = await labels(99);
  await page.keyboard.press("o");
  await lassoAll(page);
  await page.keyboard.press("x");
  await says(page.locator(".status-bar"), "undo 2");
  assert.ok((await labels(99)) < plausible);
  await page.keyboard.press("Control+z");
  await says(page.locator(".status-bar"), "undo 1");
  assert.equal(await labels(99), plausible);
  clean(tab);
});

test("a box in a camera's image and a brush in the free view select, and a class is found by typing", async (context) => {
  const { server, tab, page } = await opened(context, browser);
  const camera = await page.locator(".camera.large").boundingBox();
  await page.waitForTimeout(500);
  await page.keyboard.press("b");
  await drag(page, [
    [camera.x + 4, camera.y + 4],
    [camera.x + camera.width - 4, camera.y + camera.height - 4],
  ]);
  assert.ok((await selected(page)) > 0, "nothing selected in the camera");
  await page.keyboard.press("Escape");
  assert.equal(await selected(page), 0);
  await page.keyboard.press("t");
  await page.keyboard.press("u");
  for (let larger = 0; larger < 6; larger += 1) await page.keyboard.press("]");
  const view = await page.locator(".viewport").boundingBox();
  await drag(page, [
    [view.x + view.width * 0.2, view.y + view.height * 0.42],
    [view.x + view.width * 0.8, view.y + view.height * 0.42],
  ]);
  const count = await selected(page);
  assert.ok(count > 0, "nothing selected in the free view");
  await page.keyboard.press("c");
  await page.keyboard.type("pole");
  await page.keyboard.press("Enter");
  await says(page.locator(".status-bar"), "undo 1");
  assert.equal((await scanOf(server, await current(page))).label.filter((label) => label === 80).length, count);
  clean(tab);
});

test("killed without warning, the server loses nothing: strokes wait in the page and are saved on its return", async (context) => {
  const out = await freshOut(context);
  const server = await serve(context, out);
  const tab = await open(context, browser, server);
  const { page } = tab;
  const id = await current(page);
  const scan = await scanOf(server, id);
  const [first, second] = isolated(scan);
  const click = async (point, key) => {
    await page.keyboard.press("v");
    await page.mouse.click(...(await pixel(page, scan.x[point], scan.y[point])));
    await page.keyboard.press(key);
  };
  await click(first, "a");
  await says(page.locator(".status-bar"), "undo 1");
  await page.keyboard.press("r");
  if (await page.locator(".accept").isVisible()) await page.keyboard.press("r");
  await says(page.locator(".review"), "Reviewed by ada");
  await says(status(page), "saved");
  await server.kill("SIGKILL");
  await click(second, "a");
  await says(status(page), "1 stroke not saved");
  await says(page.locator(".banner"), "does not answer");
  const back = await serve(context, out, { port: server.port });
  await says(page.locator(".status-bar"), "undo 3");
  await says(status(page), "saved");
  await page.locator(".banner").waitFor({ state: "hidden" });
  const now = await scanOf(back, id);
  assert.deepEqual([now.corrected[first], now.corrected[second], now.label[first], now.label[second]], [1, 1, 1, 1]);
  assert.equal(now.header.reviewed.author, "ada");
  assert.equal((await historyOf(back, page)).undo_depth, 3);
  clean(tab, GONE);
});

test("a thing is answered by one key in all its scans, survives a dead server, and is undone by one", async (context) => {
  const out = await freshOut(context);
  const server = await serve(context, out);
  const tab = await open(context, browser, server);
  const { page } = tab;
  const correctedIn = async (asked) => {
    const { scans } = await queueOf(asked);
    return scans.reduce((sum, { corrected }) => sum + corrected, 0);
  };
  await page.keyboard.press("Shift+N");
  await says(page.locator(".thing-bar"), "expected to be wrong");
  const first = await selected(page);
  assert.ok(first > 0);
  const thing = await page.locator(".thing-bar").getAttribute("data-thing");
  await page.keyboard.press("a");
  await says(page.locator(".status-bar"), "undo 1");
  await says(status(page), "saved");
  assert.equal(await correctedIn(server), first);
  await page.waitForFunction((before) => document.querySelector(".thing-bar").dataset.thing !== before, thing);
  await page.keyboard.press("Escape");
  await proposing(page, server);
  await proposalIsDroppedAndAccepted(page, () => correctedIn(server));
  await page.keyboard.press("Control+z");
  await says(page.locator(".status-bar"), "redo 2");
  assert.equal(await correctedIn(server), 0);
  // The whole sequence is on screen: a lasso draws on all of its scans.
  await lassoAll(page);
  const all = await selected(page);
  assert.ok(all > first);
  assert.match(await page.locator(".work").textContent(), /in \d+ scans, most \w+, [\d,]+ say otherwise/);
  await server.kill("SIGKILL");
  await page.keyboard.press("p");
  await says(status(page), "1 stroke not saved");
  const back = await serve(context, out, { port: server.port });
  await says(page.locator(".status-bar"), "undo 1");
  await says(status(page), "saved");
  assert.equal(await correctedIn(back), all);
  await page.keyboard.press("Control+z");
  await says(page.locator(".status-bar"), "undo 0");
  assert.equal(await correctedIn(back), 0);
  clean(tab, GONE);
});

/** After one answer: what is proposed changes nothing when it's dropped, and is one step when it's accepted. */
async function proposalIsDroppedAndAccepted(page, corrected) {
  const before = await corrected();
  const bar = page.locator(".opinion-bar");
  for (const key of ["Escape", "Shift+R"]) {
    await page.keyboard.press("Shift+R");
    await says(bar, "would become");
    assert.ok((await selected(page)) > 0);
    await page.keyboard.press(key);
    await bar.waitFor({ state: "hidden" });
    if (key === "Escape") assert.equal(await corrected(), before);
  }
  await says(page.locator(".status-bar"), "undo 2");
  await says(status(page), /^saved$/);
  assert.ok((await corrected()) > before);
  await page.keyboard.press("Control+z");
  await says(page.locator(".status-bar"), "undo 1");
  assert.equal(await corrected(), before);
}

test("two tabs on one scan: the second is told, sees the newer state, and decides", async (context) => {
  const server = await serve(context, await freshOut(context));
  const own = await anotherBrowser(context, browser);
  const [early, late] = [await open(context, browser, server, own), await open(context, browser, server, own)];
  // The late tab doesn't hear of changes in time.
  await late.page.route("**/changes*", () => undefined);
  await late.page.reload();
  await ready(late.page);
  const id = await current(late.page);
  const scan = await scanOf(server, id);
  const [first, second] = isolated(scan);
  const click = async (page, point, key) => {
    await page.keyboard.press("v");
    await page.mouse.click(...(await pixel(page, scan.x[point], scan.y[point])));
    await page.keyboard.press(key);
  };
  await click(early.page, first, "a");
  await says(early.page.locator(".status-bar"), "undo 1");
  await click(late.page, second, "a");
  await says(late.page.locator(".conflict"), "ada (in another window) changed");
  await says(status(late.page), "conflict");
  assert.deepEqual([...(await scanOf(server, id)).corrected].filter(Boolean).length, 1);
  await late.page.getByRole("button", { name: "Apply my stroke to it" }).click();
  await says(late.page.locator(".status-bar"), "undo 2");
  const now = await scanOf(server, id);
  assert.deepEqual([now.label[first], now.label[second]], [1, 1]);
  // The early tab heard of it by itself.
  await says(early.page.locator(".notice"), "another window");
  await click(early.page, second, "m");
  await says(early.page.locator(".status-bar"), "undo 3");
  await click(late.page, first, "m");
  await says(late.page.locator(".conflict"), "ada (in another window) changed");
  await late.page.getByRole("button", { name: "Drop my stroke" }).click();
  await says(status(late.page), "saved");
  assert.equal((await scanOf(server, id)).label[first], 1);
  clean(early);
  clean(late, REFUSED);
});

test("every planted error is corrected by mouse and keyboard alone, and exports hold what is right", async (context) => {
  const out = await freshOut(context);
  const server = await serve(context, out);
  const tab = await open(context, browser, server);
  const { page } = tab;
  const { scans } = await queueOf(server);
  const right = new Map();
  for (const id of scans) right.set(`${id.radar}/${id.scan}`, [...(await scanOf(server, id)).machine]);
  for (const { radar, scan, point, label } of planted) right.get(`${radar}/${scan}`)[point] = label;
  assert.ok(planted.length >= 8);
  for (let seen = 1; seen <= scans.length; seen += 1) {
    await correctPlanted(server, page);
    const here = page.url();
    await accept(page);
    await says(page.locator(".queue-head"), `${seen} of ${scans.length}`);
    if (seen === scans.length) break;
    await page.waitForFunction((address) => location.href !== address, here);
    await ready(page);
  }
  const labels = await exported(out);
  for (const { radar, scan } of scans) {
    const now = await scanOf(server, { radar, scan });
    assert.deepEqual([...now.label], right.get(`${radar}/${scan}`), `${radar} ${scan}`);
    assert.deepEqual(labels.get(`${radar}/${scan}`), right.get(`${radar}/${scan}`), `${radar} ${scan}, exported`);
    assert.equal(now.header.reviewed?.author, "ada");
  }
  clean(tab);
});

/** Clicks each planted error of the scan on screen, and sets it right with a key. */
async function correctPlanted(server, page) {
  const id = await current(page);
  const table = await scanOf(server, id);
  for (const { point, label } of planted.filter(({ radar, scan }) => radar === id.radar && scan === id.scan)) {
    const depth = (await historyOf(server, page)).undo_depth;
    await page.mouse.click(...(await pixel(page, table.x[point], table.y[point])));
    assert.equal(await selected(page), 1);
    await page.keyboard.press(label === 1 ? "a" : "p");
    await says(page.locator(".status-bar"), `undo ${depth + 1}`);
  }
}

/** Two detections that no other of the scan is near, so that a click means them; plausible ones if there are. */
function isolated({ x, y, range, machine }) {
  const alone = (i) => x.every((_, j) => j === i || Math.hypot(x[i] - x[j], y[i] - y[j]) > 1.5);
  const found = [...x.keys()].filter((i) => range[i] < 38 && Math.abs(x[i]) < 38 && Math.abs(y[i]) < 38 && alone(i));
  return found.sort((a, b) => (machine[a] === 1) - (machine[b] === 1)).slice(0, 2);
}
