// What must never happen by the way: labels accepted unseen, work lost, another person's stroke taken back.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { after, before, test } from "node:test";
import {
  GONE,
  REFUSED,
  anotherBrowser,
  clean,
  current,
  drawn,
  freshOut,
  historyOf,
  launch,
  open,
  opened,
  queueOf,
  ready,
  relabel,
  says,
  scanOf,
  selected,
  serve,
  settled,
  status,
} from "./support.mjs";

const BROKEN = /status of 500/;

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

const reviewed = async (server) => (await queueOf(server)).progress.reviewed;

test("Enter that is held down accepts one scan, and none unseen", async (context) => {
  const { server, tab, page } = await opened(context, browser);
  await page.keyboard.press("f");
  await drawn(page);
  for (let repeat = 0; repeat < 30; repeat += 1) {
    // Without a release in between, the browser says that these are repeats.
    await page.keyboard.down("Enter");
    await page.waitForTimeout(30);
  }
  await page.keyboard.up("Enter");
  await says(page.locator(".queue-head"), "1 of");
  await page.waitForTimeout(300);
  assert.equal(await reviewed(server), 1);
  clean(tab);
});

test("what was never on screen is counted before it is accepted; F shows it; undo takes the mark back", async (context) => {
  const { server, tab, page } = await opened(context, browser);
  const id = await current(page);
  await page.keyboard.press("Shift+P");
  // Nearer, so that some are beside the picture.
  await page.mouse.move(...(await middle(page)));
  for (let nearer = 0; nearer < 12; nearer += 1) await page.mouse.wheel(0, -400);
  await page.reload();
  await ready(page);
  await page.keyboard.press("Enter");
  await says(page.locator(".accept"), "not on screen yet");
  await says(page.locator(".accept"), "the filter hides");
  assert.equal(await reviewed(server), 0);
  await page.keyboard.press("f");
  await page.locator(".accept").waitFor({ state: "hidden" });
  await page.keyboard.press("Enter");
  await says(page.locator(".queue-head"), "1 of");
  assert.equal((await scanOf(server, id)).header.reviewed.author, "ada");
  await says(page.locator(".status-bar"), "undo 1");
  // Scans around the current one are on screen, too: one that is isn't gone to.
  const away = id.scan < 2 ? "ArrowRight" : "ArrowLeft";
  for (let step = 0; step < 3; step += 1) {
    await page.keyboard.press(away);
    await settled(tab);
  }
  await page.keyboard.press("Control+z");
  await says(page.locator(".status-bar"), "redo 1");
  await says(page.locator(".queue-head"), "0 of");
  assert.equal((await scanOf(server, id)).header.reviewed, null);
  assert.deepEqual(await current(page), id, "and shows the scan");
  clean(tab);
});

test("labels that changed under the page are told, shown, and not accepted", async (context) => {
  const out = await freshOut(context);
  const server = await serve(context, out);
  const tab = await open(context, browser, server);
  const { page } = tab;
  await page.keyboard.press("f");
  await drawn(page);
  // What is asked for while the labels are written anew isn't there.
  await settled(tab);
  relabel(out, "fusion.threshold=1.0");
  await page.keyboard.press("r");
  await says(page.locator(".notice"), "expected the labels that were on screen, found others");
  assert.equal(await reviewed(server), 0);
  await drawn(page);
  await page.keyboard.press("r");
  await says(page.locator(".review"), "Reviewed by ada");
  await page.locator(".notice").waitFor({ state: "hidden" });
  clean(tab, REFUSED);
});

test("undo takes back one's own stroke, and another person's name is seen", async (context) => {
  const server = await serve(context, await freshOut(context));
  const [ada, bob] = [await open(context, browser, server), await open(context, browser, server)];
  await bob.page.locator(".status-bar .link").first().click();
  await bob.page.locator("dialog.name input").fill("Bob Ångström");
  await bob.page.locator("dialog.name button").click();
  await says(bob.page.locator(".status-bar"), "Bob Ångström");
  const id = await current(ada.page);
  await pickAndSet(ada.page, "a");
  await says(bob.page.locator(".notice"), "ada changed this scan");
  await bob.page.keyboard.press("d");
  await bob.page.keyboard.press("d");
  await bob.page.keyboard.press("a");
  await says(bob.page.locator(".status-bar"), "undo 1");
  await says(ada.page.locator(".notice"), "Bob Ångström changed this scan");
  await ada.page.keyboard.press("Control+z");
  await says(ada.page.locator(".status-bar"), "redo 1");
  assert.equal(
    (await scanOf(server, id)).corrected.reduce((sum, one) => sum + one, 0),
    1,
  );
  assert.deepEqual(
    [(await historyOf(server, bob.page)).undo_depth, (await historyOf(server, ada.page)).undo_depth],
    [1, 0],
  );
  clean(ada);
  clean(bob);
});

test("61 large strokes that wait for the server outlive a reload, and a window that was closed", async (context) => {
  const out = await freshOut(context);
  const server = await serve(context, out);
  const own = await anotherBrowser(context, browser);
  const tab = await open(context, browser, server, own);
  const { page } = tab;
  await page.keyboard.press("f");
  await page.keyboard.press("o");
  const scan = await current(page);
  await server.kill("SIGKILL");
  for (let stroke = 0; stroke < 61; stroke += 1) {
    await page.keyboard.press("Control+a");
    await page.keyboard.press(stroke % 2 === 0 ? "a" : "p");
  }
  await says(status(page), "61 strokes not saved");
  await page.waitForTimeout(500);
  page.on("dialog", (dialog) => void dialog.accept());
  await page.close({ runBeforeUnload: false });
  const back = await serve(context, out, { port: server.port });
  const next = await open(context, browser, back, own);
  await says(next.page.locator(".status-bar"), "undo 61");
  await says(status(next.page), /^saved$/);
  // Another scan waits first now that this one is answered.
  const labels = (await scanOf(back, scan)).label;
  assert.ok(labels.every((label) => label === 1));
  clean(next, GONE);
});

test("an answer that is lost makes neither a conflict nor a second stroke", async (context) => {
  const { server, tab, page } = await opened(context, browser);
  let lost = 0;
  await page.route(/\/(strokes|undo)$/, async (route) => {
    if (lost >= 2) return route.continue();
    lost += 1;
    await route.fetch();
    return route.abort("connectionreset");
  });
  await pickAndSet(page, "a");
  await says(page.locator(".status-bar"), "undo 1");
  await says(status(page), /^saved$/);
  await page.keyboard.press("Control+z");
  await says(page.locator(".status-bar"), "redo 1");
  const { undo_depth: undo, redo_depth: redo } = await historyOf(server, page);
  assert.deepEqual([lost, undo, redo], [2, 0, 1]);
  clean(tab, GONE);
});

test("keys that are pressed while a stroke is being saved act after it, in their order", async (context) => {
  const { server, tab, page } = await opened(context, browser);
  await page.keyboard.press("f");
  await drawn(page);
  const id = await current(page);
  await page.route(/\/strokes$/, async (route) => {
    await new Promise((resolve) => setTimeout(resolve, 500));
    await route.continue();
  });
  await pickAndSet(page, "x");
  await page.keyboard.press("Control+z");
  await pickAndSet(page, "x");
  await page.keyboard.press("Enter");
  await says(page.locator(".queue-head"), "1 of");
  const { corrected, header } = await scanOf(server, id);
  assert.equal(
    corrected.reduce((sum, one) => sum + one, 0),
    1,
  );
  assert.equal(header.reviewed.author, "ada");
  const { undo, undo_depth: depth } = await historyOf(server, page);
  assert.deepEqual([undo.tool, depth], ["reviewed", 2]);
  await page.keyboard.press("Control+z");
  await page.keyboard.press("Control+z");
  await says(page.locator(".status-bar"), "undo 0");
  clean(tab);
});

test("a store that is deleted is told, and nothing is called saved", async (context) => {
  const out = await freshOut(context);
  const server = await serve(context, out);
  const tab = await open(context, browser, server);
  const { page } = tab;
  await pickAndSet(page, "a");
  await says(page.locator(".status-bar"), "undo 1");
  spawnSync("rm", [`${out}/corrections.sqlite`]);
  await page.keyboard.press("d");
  await page.keyboard.press("d");
  await page.keyboard.press("a");
  await says(page.locator(".banner"), "it was deleted; nothing is saved any more");
  await says(status(page), "1 stroke not saved");
  await page.locator(".banner button", { hasText: "Drop the refused stroke (artifact, 1 detection)" }).click();
  await says(status(page), "nothing is saved");
  clean(tab, BROKEN);
});

test("a page writes nothing into other corrections that are served in place of its own, and its strokes wait", async (context) => {
  const [out, other] = [await freshOut(context), await freshOut(context)];
  const server = await serve(context, out);
  const own = await anotherBrowser(context, browser);
  const tab = await open(context, browser, server, own);
  const { page } = tab;
  await server.kill("SIGKILL");
  await pickAndSet(page, "x");
  await says(status(page), "1 stroke not saved");
  const second = await serve(context, out, { port: server.port, second: "bob" });
  await says(page.locator(".banner"), "`out`, second labels of bob");
  for (const key of ["d", "d", "x"]) await page.keyboard.press(key);
  await says(status(page), "2 strokes not saved");
  await second.kill("SIGKILL");
  // Other labels have another token, with which a window of theirs comes.
  const elsewhere = await serve(context, other, { port: server.port });
  const theirs = await open(context, browser, elsewhere, own);
  await says(theirs.page.locator(".brand"), "out");
  await says(page.locator(".banner"), "Another recording or output is served here now");
  await page.locator(".banner button", { hasText: "Load the page again" }).click();
  await ready(page);
  await says(status(page), /^saved$/);
  assert.equal((await historyOf(elsewhere, page)).undo_depth, 0);
  await elsewhere.kill("SIGKILL");
  const back = await serve(context, out, { port: server.port });
  const next = await open(context, browser, back, own);
  await says(next.page.locator(".status-bar"), "undo 2");
  clean(next, GONE);
});

/** Chooses a detection by keyboard, and gives it a label. */
async function pickAndSet(page, key) {
  await page.keyboard.press("d");
  assert.equal(await selected(page), 1);
  await page.keyboard.press(key);
}

async function middle(page) {
  const box = await page.locator(".viewport").boundingBox();
  return [box.x + box.width / 2, box.y + box.height / 2];
}
