// How the page stands on small and large screens, for keyboards, and for those who don't see it all.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import {
  GONE,
  accept,
  anotherBrowser,
  atEnd,
  clean,
  current,
  drag,
  drawn,
  freshOut,
  historyOf,
  launch,
  open,
  opened,
  picture,
  pixel,
  proposing,
  ready,
  says,
  scanOf,
  selected,
  serve,
  settled,
  status,
} from "./support.mjs";
import { faultsOf } from "./faults.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

test("nothing that axe calls serious is wrong with the page, its dialogs and bars", async (context) => {
  const { server, tab, page } = await opened(context, browser);
  const faults = (where) => faultsOf(page, where);
  await faults("the page");
  assert.equal(await page.locator("h1").count(), 1);
  await page.keyboard.press("d");
  await faults("a detection");
  await page.keyboard.press("a");
  await says(page.locator(".status-bar"), "undo 1");
  await faults("a correction");
  await page.keyboard.press("Shift+N");
  await page.locator(".thing-bar").waitFor();
  await page.keyboard.press("Shift+K");
  await page.locator('.over-image[aria-pressed="true"]').waitFor();
  await settled(tab);
  await faults("a thing");
  await picture(page, "thing");
  await page.keyboard.press("a");
  await says(page.locator(".status-bar"), "undo 2");
  // The next thing comes by itself.
  while ((await selected(page)) === 0) await page.waitForTimeout(50);
  await proposing(page, server);
  await page.keyboard.press("Shift+R");
  await says(page.locator(".opinion-bar"), "would become");
  await faults("a proposal");
  await picture(page, "proposal");
  await page.keyboard.press("Escape");
  await page.keyboard.press("Shift+G");
  await page.locator(".kind-bar:not([hidden])").waitFor({ timeout: 300_000 });
  await faults("a question about many");
  await picture(page, "kind");
  const before = (await historyOf(server, page)).undo_depth;
  await page.keyboard.press("p");
  await says(page.locator(".status-bar"), `undo ${before + 1}`);
  // The next question comes by itself, or there is none.
  await page.locator(".opinion-bar").waitFor({ state: "hidden" });
  await page.keyboard.press("Control+z");
  await says(page.locator(".status-bar"), `undo ${before} `);
  await page.keyboard.press("Escape");
  await page
    .locator(".filters details")
    .last()
    .evaluate((rules) => (rules.open = true));
  await page.getByRole("button", { name: "Inside" }).click();
  const box = await page.locator(".viewport").boundingBox();
  const at = (x, y) => [box.x + x * box.width, box.y + y * box.height];
  await drag(page, [at(0.3, 0.3), at(0.7, 0.3), at(0.7, 0.6), at(0.3, 0.6)]);
  await says(page.locator(".rules"), "inside in");
  await faults("a place");
  await picture(page, "place");
  const depth = (await historyOf(server, page)).undo_depth;
  await page.getByLabel("Name of the rule").fill("yard");
  await page.getByLabel("What the rule sets").selectOption({ label: "sets artifact: mirror" });
  await page.getByRole("button", { name: "Keep" }).click();
  await page.getByRole("button", { name: "yard", exact: true }).click();
  await says(page.locator(".rule-bar"), /would become artifact \(mirror\)/);
  await faults("a rule");
  await picture(page, "rule");
  await page.getByRole("button", { name: "Apply" }).click();
  await says(page.locator(".status-bar"), `undo ${depth + 1}`);
  await page.locator(".scan-bar select").selectOption({ label: "Cause said" });
  await says(page.locator(".legend"), "mirror");
  await picture(page, "cause");
  await page.keyboard.press("0");
  for (const key of ["?", "c"]) {
    await page.keyboard.press(key);
    await page.locator("dialog[open]").waitFor();
    await faults(`the dialog of ${key}`);
    await page.keyboard.press("Escape");
  }
  await page.keyboard.press("Shift+P");
  await page.reload();
  await ready(page);
  await page.keyboard.press("Enter");
  await page.locator(".accept").waitFor();
  await faults("the question");
  clean(tab);
});

for (const [width, height] of [
  [1280, 720],
  [1920, 1080],
  [3840, 2160],
]) {
  test(`on ${width} x ${height} each toolbar is one line, and all numbers can be read`, async (context) => {
    const { tab, page } = await opened(context, browser, { width, height });
    await page.keyboard.press("d");
    await page.waitForTimeout(400);
    await picture(page, `page-${width}`);
    for (const bar of [".toolbar", ".scan-bar"]) {
      const box = await page.locator(bar).boundingBox();
      const scale = await page.evaluate(() =>
        Number(getComputedStyle(document.documentElement).getPropertyValue("--scale")),
      );
      assert.ok(box.height < 50 * scale, `${bar} is ${box.height} px high`);
      const over = await page.locator(bar).evaluate((element) => element.scrollWidth - element.clientWidth);
      assert.ok(over <= 0, `${bar} is ${over} px too wide`);
    }
    const last = page.locator(".details .facts dd").last();
    // At once: facts are drawn anew as answers arrive, and one that is gone can't be waited for.
    await last.evaluate((fact) => fact.scrollIntoView());
    const [fact, screen] = [await last.boundingBox(), await page.locator(".right").boundingBox()];
    assert.ok(fact.y + fact.height <= screen.y + screen.height && fact.x + fact.width <= screen.x + screen.width);
    clean(tab);
  });
}

/** A laptop's window of 1280 x 800 that is magnified to 200 %, half of a screen, and a telephone. */
for (const [width, height] of [
  [800, 600],
  [640, 400],
  [390, 800],
]) {
  test(`on ${width} x ${height} the picture keeps its room, and what stands beside it is laid over it`, async (context) => {
    const { tab, page } = await opened(context, browser, { width, height });
    const room = await page.locator(".viewport").boundingBox();
    assert.ok(room.width >= 240 && room.height >= 240, `${room.width} x ${room.height} px are left`);
    assert.deepEqual(await covered(page), []);
    await page.keyboard.press("d");
    const numbers = page.locator(".right");
    await page.locator(".opener.numbers").click();
    await says(page.locator(".details"), "by machine");
    const laid = await numbers.boundingBox();
    assert.ok(laid.x >= 0 && laid.x + laid.width <= width && laid.width >= 240);
    await faultsOf(page, "the numbers over the picture");
    await page.locator(".opener.numbers").click();
    await numbers.waitFor({ state: "hidden" });
    const scans = page.locator(".opener.scans");
    if (await scans.isVisible()) await scans.click();
    const row = page.locator(".queue-row").nth(1);
    const { radar, scan } = await current(page);
    await row.click();
    await page.waitForFunction((before) => !location.hash.endsWith(before), `/${radar}/${scan}`);
    await picture(page, `page-${width}`);
    clean(tab);
  });
}

/** The buttons and lists above the picture that can't be pressed where they stand. */
function covered(page) {
  return page.locator(".toolbar button, .scan-bar button, .scan-bar select").evaluateAll((all) =>
    all
      .filter((one) => {
        const { x, y, width, height } = one.getBoundingClientRect();
        return !one.contains(document.elementFromPoint(x + width / 2, y + height / 2));
      })
      .map((one) => one.title || one.textContent),
  );
}

test("single detections are chosen by keyboard, one after the other, and announced", async (context) => {
  const { server, tab, page } = await opened(context, browser);
  const scan = await scanOf(server, await current(page));
  const count = scan.x.length;
  await page.keyboard.press("d");
  assert.equal(await selected(page), 1);
  const announced = page.locator(".status-bar .unseen");
  await says(announced, new RegExp(`^Detection 1 of ${count}, `));
  await page.keyboard.press("d");
  await says(announced, new RegExp(`^Detection 2 of ${count}, `));
  await page.keyboard.press("Shift+D");
  await page.keyboard.press("Shift+D");
  await says(announced, new RegExp(`^Detection ${count} of ${count}, `));
  clean(tab);
});

test("what is folded away is opened by Enter and Space, which accept and close nothing else then", async (context) => {
  const { server, tab, page } = await opened(context, browser);
  const rules = page.locator("summary", { hasText: "Rules" });
  const isOpen = () => rules.evaluate((summary) => summary.parentElement.open);
  await rules.focus();
  await page.keyboard.press("Enter");
  assert.equal(await isOpen(), true);
  await page.keyboard.press("Space");
  assert.equal(await isOpen(), false);
  await settled(tab);
  assert.equal(await page.locator(".accept").isVisible(), false);
  assert.equal((await historyOf(server, page)).undo_depth, 0);
  clean(tab);
});

test("a picture that the graphics card lost is told, shows nobody anything, and comes back", async (context) => {
  const { tab, page } = await opened(context, browser);
  await settled(tab);
  const scene = page.locator(".viewport canvas.scene");
  const before = await scene.screenshot();
  await scene.evaluate((canvas) => {
    window.taken = canvas.getContext("webgl2").getExtension("WEBGL_lose_context");
    window.taken.loseContext();
  });
  await says(page.locator(".notice"), "graphics card was taken away");
  const first = await current(page);
  await page.keyboard.press("ArrowRight");
  await ready(page);
  await page.mouse.move(...(await pixel(page, 5, 0)));
  await settled(tab);
  await page.keyboard.press("Enter");
  await page.locator(".accept").waitFor();
  await page.keyboard.press("Escape");
  await page.keyboard.press("ArrowLeft");
  await settled(tab);
  assert.deepEqual(await current(page), first);
  await page.evaluate(() => window.taken.restoreContext());
  await page.mouse.move(0, 0);
  await page.waitForTimeout(300);
  await drawn(page);
  assert.deepEqual(await scene.screenshot(), before);
  clean(tab, /CONTEXT_LOST|Context Lost|Context Restored/);
});

test("filters and colours outlive a reload, and an odd address stops nothing", async (context) => {
  const { server, tab, page } = await opened(context, browser);
  await page.keyboard.press("y");
  await page.keyboard.press("y");
  const colour = await page.locator(".scan-bar select").inputValue();
  assert.notEqual(colour, "label");
  await page.keyboard.press("Shift+A");
  await page.goto(`${new URL(server.url).origin}/#%`);
  await page.reload();
  await ready(page);
  assert.equal(await page.locator(".scan-bar select").inputValue(), colour);
  assert.equal(await page.locator(".filters .chip.artifact").getAttribute("aria-pressed"), "false");
  clean(tab);
});

test("a column that the server adds is shown and can be coloured by, without anybody naming it", async (context) => {
  const { tab, page } = await opened(context, browser);
  await page.route("**/radars/*/scans/*", async (route) => {
    const answer = await route.fetch();
    return route.fulfill({ response: answer, body: withColumn(await answer.body()) });
  });
  await page.reload();
  await ready(page);
  await page.keyboard.press("d");
  await says(page.locator(".details .facts"), "lidar_vertical");
  await says(page.locator(".details .facts"), "1.50 sigma");
  await page.locator(".scan-bar select").selectOption({ label: "lidar_vertical" });
  await says(page.locator(".legend"), "lidar_vertical");
  clean(tab);
});

test("a browser without WebGL is told what helps", async (context) => {
  const without = await launch("--disable-3d-apis");
  atEnd(context, () => without.close());
  const page = await (await anotherBrowser(context, without)).newPage();
  await page.goto((await serve(context, await freshOut(context))).url);
  await says(page.locator(".failure"), "no WebGL, which the picture needs. Turn on graphics acceleration");
  await picture(page, "without-webgl");
});

test("what is not saved has a rim of another shape than anything else", async (context) => {
  const { server, tab, page } = await opened(context, browser);
  await page.keyboard.press("d");
  await says(page.locator(".work"), "1 detection selected");
  await server.kill();
  await page.keyboard.press("a");
  await says(status(page), "1 stroke not saved");
  await says(page.locator(".legend-rims"), "not saved yet");
  const styles = await page
    .locator(".legend-rims .swatch")
    .evaluateAll((all) => all.map((one) => getComputedStyle(one).borderTopStyle));
  assert.deepEqual(styles.filter((style) => style === "dashed").length, 1);
  await picture(page, "not-saved");
  clean(tab, GONE);
});

/** The table with one more column, of numbers in sigmas. */
function withColumn(body) {
  const length = body.readUInt32LE(0);
  const header = JSON.parse(body.subarray(4, 4 + length).toString());
  const columns = body.subarray(4 + length);
  const values = Buffer.from(new Float32Array(header.rows).fill(1.5).buffer);
  const column = { name: "lidar_vertical", type: "f32", offset: Math.ceil(columns.length / 8) * 8 };
  header.columns.push({ ...column, unit: "sigma", meaning: "vertical part of the LiDAR residual", group: "mismatch" });
  let text = JSON.stringify(header);
  while ((4 + text.length) % 8 !== 0) text += " ";
  const whole = Buffer.alloc(4 + text.length + column.offset + values.length);
  whole.writeUInt32LE(text.length);
  whole.write(text, 4);
  columns.copy(whole, 4 + text.length);
  values.copy(whole, 4 + text.length + column.offset);
  return whole;
}
