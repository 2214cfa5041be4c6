// Classes that the machine gave: by colour, by filter, of one detection, and a person's above them.
import assert from "node:assert/strict";
import { readdir, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { faultsOf } from "./faults.mjs";
import {
  anotherBrowser,
  ask,
  clean,
  current,
  freshFolder,
  launch,
  open,
  picture,
  ralf,
  ready,
  says,
  scanOf,
  sequenceOf,
  serve,
  settled,
} from "./support.mjs";

const BUILDING = 50;
const TRUCK = 18;
/** Side of a field on which all LiDAR points carry a class, or none does. */
const FIELD_M = 8;

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

/** The LiDAR's points carry a class on every other field of the ground, and all images a segmentation. */
async function labelled(context) {
  const folder = await freshFolder(context);
  const [dataset, out] = ["recording", "out"].map((name) => join(folder, name));
  ralf("simulate", "-o", dataset, "--preset", "tiny", "--scans", "2", "--segmentation", "--quiet");
  const [sequence] = await readdir(join(dataset, "sequences"));
  const lidar = join(dataset, "sequences", sequence, "lidar_top");
  for (const scan of (await readdir(lidar)).filter((name) => name.endsWith(".bin"))) {
    const bytes = await readFile(join(lidar, scan));
    const points = new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
    const field = (i) => Math.floor(points[4 * i] / FIELD_M) + Math.floor(points[4 * i + 1] / FIELD_M);
    const ids = Uint32Array.from({ length: points.length / 4 }, (_, i) => (field(i) % 2 === 0 ? BUILDING : 0));
    await writeFile(join(lidar, scan.replace(".bin", ".label")), ids);
  }
  ralf("label", dataset, "-o", out, "--quiet");
  return { dataset, out };
}

/** The detections of all radars at the moment that is under review, and whether they are of the scan itself. */
async function onScreen(server, page) {
  const id = await current(page);
  const { t_ns } = (await scanOf(server, id)).header;
  const moment = `sequences/${await sequenceOf(server)}/moment?t_ns=${t_ns}&radars=all`;
  const { scans } = await (await ask(server, moment)).json();
  const found = scans.map(async ({ radar, scan }) => {
    const { label, class_from } = await scanOf(server, { radar, scan });
    const current = radar === id.radar && scan === id.scan;
    return [...label].map((one, i) => ({ label: one, from: class_from[i], current }));
  });
  return (await Promise.all(found)).flat();
}

test("classes are coloured, filtered and told with what gave them, and a person's comes first", async (context) => {
  const { dataset, out } = await labelled(context);
  const server = await serve(context, out, { dataset });
  const own = await anotherBrowser(context, browser, { width: 1280, height: 720 });
  const tab = await open(context, browser, server, own);
  const { page } = tab;
  const { classes } = await (await ask(server, "recording")).json();
  const nameOf = new Map(classes.map(({ id, name }) => [id, name]));
  const all = await onScreen(server, page);
  const shown = (test) => all.filter(({ label, from }) => test(label, from)).length;
  const [byLidar, byCamera] = [1, 2].map((source) => shown((_, from) => from === source));
  assert.ok(byLidar > 0 && byCamera > 0, `${byLidar} by the LiDAR, ${byCamera} by cameras`);
  const legend = page.locator(".legend-entries");
  const entries = () => legend.locator(".legend-entry").allTextContents();
  const colour = (label) => page.locator(".scan-bar select").selectOption({ label });

  await colour("Class");
  const ids = [...new Set(all.map(({ label }) => label))].sort((a, b) => a - b);
  const words = new Map([...nameOf, [1, "artifact"], [99, "plausible, no class"]]);
  assert.deepEqual(
    await entries(),
    ids.map((one) => words.get(one)),
  );
  await settled(tab);
  await picture(page, "classes");
  await page.keyboard.press("Shift+L");
  await settled(tab);
  await picture(page, "classes-light");
  await page.keyboard.press("Shift+L");
  await colour("Class from");
  assert.deepEqual(await entries(), ["lidar", "camera", "no class"]);
  await settled(tab);
  await picture(page, "class-from");

  const filters = page.locator(".filters");
  const count = (of) =>
    says(filters.locator("header"), `${of.toLocaleString("en")} of ${all.length.toLocaleString("en")}`);
  await filters.locator("summary", { hasText: "Classes" }).click();
  await filters.getByRole("button", { name: "camera", exact: true }).click();
  await count(byCamera);
  const one = all.find(({ current, from }) => current && from === 2).label;
  await filters.getByRole("button", { name: nameOf.get(one), exact: true }).click();
  await count(shown((label, from) => label === one && from === 2));
  // A button that is pressed by key keeps the focus, whatever the filter then shows.
  await filters.getByRole("button", { name: nameOf.get(one), exact: true }).focus();
  const focused = () =>
    page.evaluate(() => document.activeElement.getAttribute("aria-label") ?? document.activeElement.textContent);
  await page.keyboard.press("Space");
  await count(byCamera);
  assert.equal(await focused(), nameOf.get(one));
  await page.keyboard.press("Space");
  await count(shown((label, from) => label === one && from === 2));
  assert.equal(await focused(), nameOf.get(one));
  await faultsOf(page, "a filter of classes");
  await settled(tab);
  await picture(page, "class-filter");
  // What is asked for outlives the page.
  await page.reload();
  await ready(page);
  await count(shown((label, from) => label === one && from === 2));

  const facts = page.locator(".details .facts");
  await page.keyboard.press("d");
  await says(page.locator(".details h2"), `${nameOf.get(one)}by machine`);
  await says(facts, "class fromcamera");
  await page.keyboard.press("c");
  await page.keyboard.type(nameOf.get(TRUCK));
  await page.keyboard.press("Enter");
  await says(page.locator(".status-bar"), "undo 1");
  await page.keyboard.press("0");
  await count(all.length);
  assert.deepEqual(await entries(), ["a person", "lidar", "camera", "no class"]);
  const now = await scanOf(server, await current(page));
  const mine = now.corrected.indexOf(1);
  assert.deepEqual([now.label[mine], now.machine[mine], now.class_from[mine]], [TRUCK, one, 2]);
  await filters.locator("summary", { hasText: "Classes" }).click();
  await filters.getByRole("button", { name: "a person", exact: true }).click();
  await count(1);
  await page.keyboard.press("d");
  await says(page.locator(".details h2"), `${nameOf.get(TRUCK)}corrected`);
  await says(facts, `machine${nameOf.get(one)} (camera)`);
  await says(facts, "class froma person");
  await settled(tab);
  await picture(page, "class-by-person");
  // However much of the filters is open, all of it can be reached, and the queue stays.
  for (const name of ["Flags", "Rules"]) await filters.locator("summary", { hasText: name }).click();
  const keep = page.getByRole("button", { name: "Keep", exact: true });
  await keep.evaluate((button) => button.scrollIntoView());
  const [button, row] = [await keep.boundingBox(), await page.locator(".queue-row").first().boundingBox()];
  assert.ok(button.y + button.height < 720 && button.y > row.y + row.height, JSON.stringify([button, row]));
  await picture(page, "filters-open");
  // Who types one end of a column goes on to the other.
  await page.getByLabel("Column to filter by").selectOption("d_lm");
  await page.getByLabel("d_lm: least").focus();
  await page.keyboard.type("0.5");
  await page.keyboard.press("Tab");
  assert.equal(await focused(), "d_lm: most");
  assert.equal(await page.getByLabel("d_lm: least").inputValue(), "0.5");
  await page.getByTitle("Ask nothing of d_lm").click();
  await page.getByLabel("d_lm: most").waitFor({ state: "detached" });
  clean(tab);
});
